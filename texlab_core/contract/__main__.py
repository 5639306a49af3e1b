"""``python -m texlab_core.contract PACKAGE``: hold the methods of an installed package to their promises."""

from __future__ import annotations

import sys

from texlab_core.contract.checking import check_method, methods_of
from texlab_core.errors import InputError

USAGE = "usage: python -m texlab_core.contract PACKAGE"


def main(arguments: list[str]) -> int:
    """Print what is kept and what is broken; return 0 when all is kept, 1 when not, 2 when nothing is checked."""
    if len(arguments) != 1 or arguments[0].startswith("-"):
        print(USAGE, file=sys.stdout if arguments in (["-h"], ["--help"]) else sys.stderr)
        return 0 if arguments in (["-h"], ["--help"]) else 2
    try:
        methods = methods_of(arguments[0])
    except InputError as error:
        print(error, file=sys.stderr)
        return 2
    broken = 0
    for method in methods:
        print(f"{method.title}:")
        for finding in check_method(method):
            broken += bool(finding.problem)
            print(f"  {'BROKEN' if finding.problem else 'kept'}  {finding.check}: {finding.promise}")
            if finding.problem:
                print(f"          {finding.problem}")
    print(f"{broken} promises are broken." if broken else "Every promise is kept.")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
