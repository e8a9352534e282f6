"""The command `treadwell`: Ctrl-C while the package is loaded ends it without a traceback."""

import signal


def main() -> None:
    """Load the command line, and run it."""
    handler = signal.getsignal(signal.SIGINT)
    if handler is signal.default_int_handler:  # and not ignored, as in the background of a shell
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    from treadwell.cli import app

    signal.signal(signal.SIGINT, handler)
    app.main()


if __name__ == "__main__":
    main()
