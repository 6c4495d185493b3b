"""What can go wrong, as the command's exit codes tell it."""


class Error(Exception):
    """A failure, told in one line: what, where, the value and the limit, and what to try.

    `what`, `where`, `value`, `limit` and `advice` are these parts, as text, empty where there is none; `at` is a place
    (x, y, z) in model units, or None; `exit_code` is the command's. Options are named as on the command line.
    """

    exit_code = 4

    def __init__(self, line, what="", where="", value="", limit="", advice="", at=None):
        super().__init__(line)
        self.what, self.where, self.value, self.limit, self.advice, self.at = what, where, value, limit, advice, at


class WrongUsage(Error):
    """Options contradict one another or the input."""

    exit_code = 2


class InvalidInput(Error):
    """The input cannot be read, or what it holds is not a mesh."""

    exit_code = 3


class NotMeshable(Error):
    """No valid mesh can be made of the input."""

    exit_code = 4


class OutOfTime(NotMeshable):
    """The time limit is over, and there is no valid mesh yet."""


class MeshingFailed(Error):
    """The tetrahedral mesher failed, crashed, or met its time or memory limit."""

    exit_code = 5


class IoError(Error):
    """The output cannot be written."""

    exit_code = 6


class Cancelled(Error):
    """The progress callback returned False."""

    exit_code = 130


class GateFailed(Error):
    """A gate of `require` or `gates` failed, and there is no mesh; `figures` are those of the one that failed."""

    exit_code = 1

    def __init__(self, line, figures):
        super().__init__(line, what=line)
        self.figures = figures

    def __reduce__(self):  # exceptions are made again of their line alone
        return type(self), (str(self), self.figures)


class MeshWarning(UserWarning):
    """What a person should know of a mesh that was read, made or written all the same."""
