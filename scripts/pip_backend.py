"""Builds a wheel of the Python module with CMake, for pip (PEP 517).

    pip install .
    pip install --config-settings=build=build/release .     # with what is built in that folder
"""

import base64
import hashlib
import os
import pathlib
import subprocess
import sys
import sysconfig
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
METADATA = """Metadata-Version: 2.1
Name: dinal
Version: {}
Summary: A laboratory for oscillators with dry friction
License: MIT
Requires-Python: >=3.10
"""
WHEEL = """Wheel-Version: 1.0
Generator: dinal
Root-Is-Purelib: false
Tag: {}
"""


def version():
    text = (ROOT / "src/text/version.hpp").read_text()
    return text.partition('#define DINAL_VERSION "')[2].partition('"')[0]


def built(build):
    """The folder of the package, after CMake has made what is stale in it."""
    if build is None:
        build = ROOT / "build" / f"wheel-{sys.implementation.cache_tag}"
        subprocess.run(["cmake", "-G", "Ninja", "-S", ROOT, "-B", build, "-DCMAKE_BUILD_TYPE=Release", "-DDINAL_UNITY=room",
                        "-DDINAL_PYTHON=ON", f"-DPython_EXECUTABLE={sys.executable}"], check=True)
    subprocess.run(["cmake", "--build", build, "--target", "dinal_python"], check=True)
    return pathlib.Path(build, "python", "dinal")


def tag():
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"


def metadata():
    """The files about the package, by their names in the wheel."""
    about = f"dinal-{version()}.dist-info"
    return {f"{about}/METADATA": METADATA.format(version()).encode(), f"{about}/WHEEL": WHEEL.format(tag()).encode(),
            f"{about}/LICENSE": (ROOT / "LICENSE").read_bytes()}


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    for name, content in metadata().items():
        path = pathlib.Path(metadata_directory, name)
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(content)
    return path.parent.name


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    folder = built((config_settings or {}).get("build"))
    files = {f"dinal/{file.name}": file.read_bytes() for file in sorted(folder.iterdir()) if file.is_file()}
    files.update(metadata())
    record = ""
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        record += f"{name},sha256={digest},{len(content)}\n"
    about = f"dinal-{version()}.dist-info"
    files[f"{about}/RECORD"] = f"{record}{about}/RECORD,,\n".encode()
    wheel = f"dinal-{version()}-{tag()}.whl"
    with zipfile.ZipFile(os.path.join(wheel_directory, wheel), "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return wheel
