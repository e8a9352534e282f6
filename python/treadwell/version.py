"""The package's version, for all that writes it down."""

from importlib.metadata import version

__version__ = version("treadwell")
