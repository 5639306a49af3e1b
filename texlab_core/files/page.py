"""Pages of HTML that need no other file: style and script inside, pictures beside them, no network."""

from __future__ import annotations

from html import escape


def page_head(title: str, style: str) -> str:
    """Return the beginning of a page with this CSS, down to its heading, which is the title (plain text)."""
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src 'self' file: data:; \
style-src 'unsafe-inline'; script-src 'unsafe-inline'">
<title>{escape(title)}</title>
<style>{style}</style>
</head>
<body>
<h1>{escape(title)}</h1>
"""


def page_end(script: str) -> str:
    """Return the end of a page with this JavaScript."""
    return f"""<script>{script}</script>
</body>
</html>
"""
