"""One file per synthesis method; each registers itself with ``texlab_core.registry.register``."""
