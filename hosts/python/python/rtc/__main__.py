"""`python -m rtc`: the command line."""

from . import main

main()
