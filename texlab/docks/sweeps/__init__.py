"""One or two knobs over ranges, as a contact sheet."""
