"""Where molecules stand at the start, and how they move.

`scatter`    at random
`overlap`    those that overlap are pushed apart
`clearing`   those that a drop reaches are placed anew
`lattice`    on a lattice
`velocity`   velocities and energies of rotation
"""
