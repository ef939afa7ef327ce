"""Positions and velocities of the molecules at the start.

`scatter`    positions at random
`overlap`    which molecules overlap, and pushing them apart
`clearing`   molecules that overlap a drop get new positions
`lattice`    positions on a lattice
`velocity`   velocities and rotational energies
`start`      how molecules start, as data: which of these are drawn, and in which order
"""
