"""Positions and velocities of the molecules at the start.

`scatter`    positions at random
`overlap`    which molecules overlap, and how they and drops are moved apart
`lattice`    positions on a lattice
`velocity`   velocities and rotational energies
`start`      how molecules start, as data: which of these are drawn, and in which order
"""
