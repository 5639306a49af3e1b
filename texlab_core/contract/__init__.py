"""What every method promises, as checks that any package can run on its own methods.

    python -m texlab_core.contract PACKAGE

runs all of them on the methods that an installed package adds. The program's own tests run the same checks.
"""
