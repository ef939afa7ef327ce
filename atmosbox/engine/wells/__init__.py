"""Molecules that attract each other, from event to event: a square well about each of them. Read from top to bottom.

`attraction`           how far and how deep the wells are, pair of species by pair; a bath that draws velocities anew
`vicinity`             whom a molecule can meet soon, and whose well it is in
`well_events`          captures, releases, and the loop over events
`attracting_parcelset` the box of such molecules, advanced exactly
`attracting_reference` the same model, slow and simple: the tests compare with it
"""
