"""Commands, one file for each: options and order of steps."""
