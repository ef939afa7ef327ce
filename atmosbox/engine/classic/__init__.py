"""The schemes of teaching applets: a fixed step, and an overlap test.

`classic_tally`       the common part of the three schemes
`classic_strips`      equal discs, sorted into strips
`classic_lookahead`   unequal discs, with a look ahead in time
`classic_spheres`     spheres, all pairs
`classic`             the box, advanced by one of the three
"""
