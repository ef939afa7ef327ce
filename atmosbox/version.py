"""The version of atmosbox, written once: the build, the files of runs and the command line read it from here."""

__version__ = "0.2.0"
