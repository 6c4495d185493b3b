"""The meshes of Debian's libcgal-demo, unpacked for the scripts of this folder."""
import contextlib
import os
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
