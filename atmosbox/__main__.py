"""Run the command line as ``python -m atmosbox``."""

from atmosbox.cli import main

if __name__ == "__main__":
    main()
