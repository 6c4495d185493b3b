"""Makes a wheel of the Python module: what pip asks of a project (PEP 517), by CMake and the standard library alone.

It is in-house since Debian 12 has no scikit-build-core, and so that `pip install .` works without a package index. The
wheel is for this machine and its kin: the module links Debian's libraries.
"""
import base64
import hashlib
import os
import re
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
BUILD = PROJECT / "build" / "wheel"


def _in_pyproject(name):
    return re.search(rf'^{name} = .*?"(.*?)"', (PROJECT / "pyproject.toml").read_text("utf-8"), re.MULTILINE)[1]


def _version():
    return re.search(r"project\(scan2fea VERSION (\S+)", (PROJECT / "CMakeLists.txt").read_text("utf-8"))[1]


def _metadata():
    return (f"Metadata-Version: 2.1\nName: scan2fea\nVersion: {_version()}\nSummary: {_in_pyproject('description')}\n"
            f"License: {_in_pyproject('license')}\nRequires-Python: {_in_pyproject('requires-python')}\n"
            f"Requires-Dist: {_in_pyproject('dependencies')}\n")


def _entry_points():
    group = re.search(r'^\[project\.entry-points\."([^"]+)"\]\n(.*)', (PROJECT / "pyproject.toml").read_text("utf-8"),
                      re.MULTILINE | re.DOTALL)
    return f"[{group[1]}]\n" + group[2].replace('"', "")


# The package in the build folder, with TetGen's worker and MED's module beside the module.
def _build():
    environment = {**os.environ, "CCACHE_BASEDIR": str(PROJECT), "CCACHE_NOHASHDIR": "1"}
    memory_gb = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_AVPHYS_PAGES") / 1e9
    jobs = max(1, min(len(os.sched_getaffinity(0)), int(memory_gb / 2)))  # 2 GB each, see examples/setup
    for step in (["-G", "Ninja", "-S", PROJECT, "-B", BUILD, "-D", "CMAKE_BUILD_TYPE=Release", "-D", "SCAN2FEA_TESTS=OFF",
                  "-D", f"Python3_EXECUTABLE={sys.executable}"],
                 ["--build", BUILD, "--target", "scan2fea_python", "--parallel", str(jobs)]):
        subprocess.run(["cmake", *step], check=True, env=environment)
    files = sorted(file for file in (BUILD / "python" / "scan2fea").iterdir() if file.is_file())
    if not any(file.name.startswith("_scan2fea.") for file in files):
        raise SystemExit("no Python module was built: apt-get install python3-dev pybind11-dev")
    return files


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    python = f"cp{sys.version_info[0]}{sys.version_info[1]}"
    tag = f"{python}-{python}-{re.sub('[-.]', '_', sysconfig.get_platform())}"
    described = f"scan2fea-{_version()}.dist-info"
    entries = [(f"scan2fea/{file.name}", file.read_bytes(), 0o755 if os.access(file, os.X_OK) else 0o644)
               for file in _build()]
    entries += [(f"{described}/{name}", text.encode(), 0o644) for name, text in (
        ("METADATA", _metadata()),
        ("WHEEL", f"Wheel-Version: 1.0\nGenerator: scan2fea\nRoot-Is-Purelib: false\nTag: {tag}\n"),
        ("entry_points.txt", _entry_points()),
        ("LICENSE", (PROJECT / "LICENSE").read_text("utf-8")))]
    record = "".join(
        f"{name},sha256={base64.urlsafe_b64encode(hashlib.sha256(content).digest()).decode().rstrip('=')},{len(content)}\n"
        for name, content, _ in entries) + f"{described}/RECORD,,\n"
    wheel = f"scan2fea-{_version()}-{tag}.whl"
    with zipfile.ZipFile(os.path.join(wheel_directory, wheel), "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content, mode in [*entries, (f"{described}/RECORD", record.encode(), 0o644)]:
            entry = zipfile.ZipInfo(name)  # of a fixed date: the same bytes each time
            entry.external_attr, entry.compress_type = (0o100000 | mode) << 16, zipfile.ZIP_DEFLATED
            archive.writestr(entry, content)
    return wheel


def build_sdist(sdist_directory, config_settings=None):
    raise UnsupportedOperation("take a clone of the project instead")


class UnsupportedOperation(Exception):
    pass
