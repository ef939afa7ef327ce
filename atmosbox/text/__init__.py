"""The results of a run as text: tables that fit their width, and numbers with as many digits as their error allows.

The command line prints this text, and a run in Python shows it above its variables.
"""
