"""The schemes of teaching applets: a fixed step, and an overlap test.

`classic_tally`       what the three schemes share
`classic_strips`      equal discs, sorted into strips
`classic_lookahead`   unequal discs, which look ahead
`classic_spheres`     spheres, all pairs
`classic`             the box, advanced by one of the three
"""
