"""Molecules that attract each other, with a square well around each; event-driven. Read from top to bottom.

`attraction`           range and depth of the wells for each pair of species; a bath that draws velocities again
`vicinity`             lists of the neighbours that a molecule can meet soon, and of those in its well
`well_events`          captures, releases, and the loop over events
`well_advance`         the loop, and lists of neighbours that grow
`attracting_parcelset` the box of such molecules, advanced exactly
`attracting_reference` the same model, slow and simple: the tests compare with it
"""
