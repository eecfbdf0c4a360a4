"""The compiled physics: numbers in, numbers out."""
