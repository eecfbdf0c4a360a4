"""The commands, one file each: options and the order of steps."""
