"""PyInstaller: commands, docks and views are found by listing their packages."""

from __future__ import annotations

from PyInstaller.utils.hooks import collect_data_files, collect_submodules

hiddenimports = collect_submodules("texlab", filter=lambda name: not name.startswith("texlab._pyinstaller"))
datas = collect_data_files("texlab")
