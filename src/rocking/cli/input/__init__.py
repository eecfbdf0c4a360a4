"""What is typed, made into the arguments of public functions."""
