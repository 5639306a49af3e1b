#!/bin/sh
# Put TexLab into the menu of the desktop: entry, icon, file types, manual page. With a folder as argument, or for you.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
share=${1:-${XDG_DATA_HOME:-$HOME/.local/share}}
install -Dm644 "$here/texlab.desktop" "$share/applications/texlab.desktop"
install -Dm644 "$here/texlab-mime.xml" "$share/mime/packages/texlab.xml"
install -Dm644 "$here/texlab.metainfo.xml" "$share/metainfo/texlab.metainfo.xml"
install -Dm644 "$here/../icons/texlab.svg" "$share/icons/hicolor/scalable/apps/texlab.svg"
install -Dm644 "$here/../icons/texlab-256.png" "$share/icons/hicolor/256x256/apps/texlab.png"
if command -v texlab >/dev/null; then
    mkdir -p "$share/man/man1"
    texlab manpage >"$share/man/man1/texlab.1"
fi
for tool in "update-desktop-database $share/applications" "update-mime-database $share/mime"; do
    if command -v "${tool%% *}" >/dev/null; then $tool; fi
done
