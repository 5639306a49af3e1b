"""Build the site of the Python package: ``python .ci/build_docs.py [FOLDER]`` (build/docs when left out).

The pages of the package come from its docstrings, by pdoc: one small library that reads numpy's style, needs no
configuration and no other tool. The tutorials are Markdown; what they print is what a test has seen them print.
"""

from __future__ import annotations

import importlib
import re
import sys
import warnings
from html import escape
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DOCS = ROOT / "resources" / "docs"
STYLE = """
body { font: 16px/1.55 system-ui, sans-serif; max-width: 46rem; margin: 2rem auto; padding: 0 1rem; }
pre { background: #8881; padding: .7rem; overflow-x: auto; border-radius: 4px; }
code { font-size: .92em; }
table { border-collapse: collapse; }
td, th { border: 1px solid #8884; padding: .2rem .6rem; text-align: left; }
:root { color-scheme: light dark; }
"""
# The public face of the package; pdoc follows what they show.
FRONT = "texlab_core"
MODULES = (
    FRONT,
    *("texlab_core.api", "texlab_core.series", "texlab_core.progress", "texlab_core.contract"),
    *("texlab_core.engine.params", "texlab_core.engine.registry", "texlab_core.engine.steps"),
    *(
        "texlab_core.engine.inputs",
        "texlab_core.engine.job",
        "texlab_core.engine.run",
        "texlab_core.engine.result",
    ),
    *("texlab_core.images.exemplar", "texlab_core.images.gallery", "texlab_core.documents.record"),
    *("texlab_core.measures.registry", "texlab_core.measures.subject"),
    # A package stands for all that is in it.
    "texlab_core.batch",
    *("texlab_core.transforms.steerable", "texlab_core.transforms.gaussian", "texlab_core.transforms.laplacian"),
)


def main(arguments: list[str]) -> int:
    """Build the site; return 0."""
    out = Path(arguments[0]) if arguments else ROOT / "build" / "docs"
    build(out)
    print(out / "index.html")
    return 0


def build(out: Path) -> None:
    """Write the whole site into a folder."""
    import pdoc
    import pdoc.render

    sys.path.insert(0, str(ROOT))
    front = importlib.import_module(FRONT)
    # Its names are imported when they are first used; pdoc looks only for what is there.
    vars(front).update({name: getattr(front, name) for name in front.__all__})
    pdoc.render.configure(docformat="numpy", footer_text="TexLab", search=True)
    with warnings.catch_warnings():
        # Types that are imported for the checker only are shown by their names.
        warnings.filterwarnings("ignore", "Error parsing type annotation", UserWarning)
        pdoc.pdoc(*MODULES, output_directory=out / "api")
    pages = tutorials()
    for path in pages:
        (out / f"{path.stem}.html").write_text(page(path.read_text("utf-8")), "utf-8")
    listed = "\n".join(f"- [{title(path)}]({path.stem}.html)" for path in pages)
    start = (
        "# TexLab in Python\n\nExample-based texture synthesis: arrays in, arrays out. "
        "`pip install texlab`, then `import texlab_core`.\n\n"
        f"## Tutorials\n\n{listed}\n\n## Reference\n\n- [The package](api/texlab_core.html)\n"
    )
    (out / "index.html").write_text(page(start), "utf-8")


def tutorials() -> list[Path]:
    """Return the tutorials, in their order."""
    return sorted((DOCS / "tutorials").glob("*.md"))


def title(path: Path) -> str:
    """Return the title of a tutorial: its first line."""
    return path.read_text("utf-8").partition("\n")[0].removeprefix("# ")


def page(text: str) -> str:
    """Return a page of Markdown as HTML."""
    import markdown2

    body = markdown2.markdown(text, extras=["fenced-code-blocks", "tables", "header-ids"])
    # Links between tutorials are to files of Markdown, so that they work in the checkout too.
    body = re.sub(r'href="([\w-]+)\.md"', r'href="\1.html"', str(body))
    name = escape(text.partition("\n")[0][2:])
    return (
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{name}</title>'
        f"<style>{STYLE}</style></head><body>\n{body}\n</body></html>\n"
    )


def code_of(text: str) -> str:
    """Return the code of a tutorial: its blocks of Python, one after the other, on the lines where they stand."""
    lines = []
    inside = False
    for line in text.splitlines():
        if line.startswith("```"):
            inside = line == "```python"
            lines.append("")
        else:
            lines.append(line if inside else "")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
