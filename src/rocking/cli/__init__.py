"""Command `rocking`: a table of commands, their inputs and their reports."""
