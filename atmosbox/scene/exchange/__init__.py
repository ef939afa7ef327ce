"""Vapour and liquid that exchange molecules until both rates are equal: the theory that these scenes share."""
