"""What is printed of a result."""
