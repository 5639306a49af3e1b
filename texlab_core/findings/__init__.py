"""What is wrong with a result, why, and what to try: findings over the measures.

A file of this folder declares detectors by :func:`texlab_core.findings.registry.register`; other packages do it
in a
module that they name as an entry point of the group ``texlab_core.findings``.
"""
