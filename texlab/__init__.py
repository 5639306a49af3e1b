"""The TexLab application: window and command line."""
