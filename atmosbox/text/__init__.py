"""What came out of a run, as text: tables that fit their width, numbers with the digits that they deserve.

The command line prints it, and a run in Python shows it above its variables.
"""
