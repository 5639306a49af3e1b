"""The textbook's laboratory: one tab with a row of experiments, each a file of this folder."""
