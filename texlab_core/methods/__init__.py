"""The synthesis methods: a file each, or a folder whose ``method.py`` (or ``method_*.py``, one each) declares it.

Each registers itself with :func:`texlab_core.engine.registry.register`.
"""
