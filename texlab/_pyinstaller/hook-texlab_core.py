"""PyInstaller: methods are found by listing their package, resources by their package's name."""

from __future__ import annotations

from pathlib import Path

from PyInstaller.utils.hooks import collect_data_files, collect_submodules, copy_metadata

import texlab_core
from texlab_core.engine.run import LIBRARIES

# imagecodecs loads its codecs by name.
hiddenimports = [*collect_submodules("texlab_core"), *collect_submodules("imagecodecs")]
datas = collect_data_files("texlab_resources")
if not datas:  # a checkout, where the package texlab_resources is the folder resources
    datas = [(str(Path(texlab_core.__file__).resolve().parent.parent / "resources"), "texlab_resources")]
# numba keeps machine code beside the sources of the kernels, so that these must be files, and nothing else.
module_collection_mode = {"texlab_core.kernels": "py"}
# Recipes name the versions of the libraries.
for library in LIBRARIES:
    datas += copy_metadata(library)
