"""`python -m rocking`: the command, without its being installed on the path."""

from rocking.cli import main

main.main()
