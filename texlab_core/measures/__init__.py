"""Numbers about a result: one file (or small group of files) per measure.

Each registers itself with :func:`texlab_core.measures.registry.register`; ask
:func:`texlab_core.measures.registry.measures` for all of them, about a
:class:`texlab_core.measures.subject.Subject`.
"""
