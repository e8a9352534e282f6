"""The errors that a user can meet: one base class, and one for bad input."""


class TreadwellError(Exception):
    """Anything that goes wrong in treadwell and is reported in one message, without a traceback."""


class InputError(TreadwellError):
    """What the user gave is bad: a file, a key, a value, an option. The command line exits with 2.

    The message names the file, the key or line, what was found and what is allowed.
    """


class CoreError(TreadwellError):
    """A stage of the core refused what it was given, or failed; the message names the stage."""


class EpisodeError(TreadwellError):
    """The episode cannot go on: the physics diverged, or a component of the user's failed."""


class SimulationError(TreadwellError):
    """The physics left what it can compute: a state that is not finite, or a full buffer."""


class RecordingError(TreadwellError):
    """A recording cannot be written any more: a full disk, a file that vanished. Names the file."""


class ShellLimitError(TreadwellError):
    """The shell allows less memory than is needed (`ulimit`), which is no fault of the input."""
