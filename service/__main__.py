"""`python -m service`: the same as the `risorius` command."""

from .cli import main

if __name__ == "__main__":
    main()
