"""One file per command of ``texlab``; a file whose name starts with an underscore is none.

A command is a module with

- ``HELP``: one line for the list of commands,
- ``ORDER``: its place in that list,
- ``configure(parser)``: adds its arguments to a :class:`texlab.cli.parser.Parser`,
- ``execute(args)``: does it and returns the exit code; raises ``InputError`` or ``OSError``
  for what the user can mend,
- perhaps ``READS``, names of arguments that take ``-`` for an image on standard input, and ``WRITES``, the ending
  of what ``--out -`` writes to standard output.

What costs time to import is imported inside ``execute``.
"""
