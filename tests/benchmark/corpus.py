"""The meshes of Debian's libcgal-demo, unpacked, and a process with limits for each: for tests/corpus and the scripts
of this folder."""
import contextlib
import math
import os
import resource
import subprocess
import tarfile
import tempfile

ARCHIVE = "/usr/share/doc/libcgal-dev/data.tar.gz"  # of the Debian package libcgal-demo


@contextlib.contextmanager
def unpacked(corpus=ARCHIVE):
    """The folder with the meshes: that of the archive in a temporary folder, or `corpus` itself if it is a folder."""
    if os.path.isdir(corpus):
        yield corpus
        return
    with tempfile.TemporaryDirectory() as folder:
        with tarfile.open(corpus) as archive:
            archive.extractall(folder, [m for m in archive if "/meshes/" in m.name])
        yield os.path.join(folder, "data", "meshes")


def limited(command, seconds, gigabytes=math.inf):
    """Exit status (below 0: the signal), the lines of stderr, processor seconds and megabytes at the most."""
    def limit():
        resource.setrlimit(resource.RLIMIT_CPU, (int(seconds + 1), int(seconds + 2)))
        if math.isfinite(gigabytes):
            resource.setrlimit(resource.RLIMIT_AS, (int(gigabytes * 2**30),) * 2)
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    with tempfile.TemporaryFile("w+", errors="replace") as messages:
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=messages,
                                   preexec_fn=limit)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        messages.seek(0)
        lines = messages.read().splitlines()
    return process.returncode, lines, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024
