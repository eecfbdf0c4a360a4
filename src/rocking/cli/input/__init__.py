"""Options and study files, made into the arguments of public functions."""
