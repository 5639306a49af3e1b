"""What the program ships beside its code; installed as ``texlab_resources``."""
