"""`python -m treadwell` is the command `treadwell`."""

from treadwell.cli.start import main

if __name__ == "__main__":
    main()
