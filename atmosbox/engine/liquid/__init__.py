"""Condensed water: a reservoir of molecules and energy, in the form of a mist, of drops or of a pool.

`substance`         the condensing substance, and the forms of its liquid
`reservoir`         the condensed molecules, and the laws of exchange
`insertion`         a molecule leaves the box, or enters it at a free place
`moist_account`     the properties and tallies of a box with liquid
`moist`             the loop over events, with a mist or a pool
`moist_loop`        the loop of the engine for one set of modes
`moist_parcelset`   the box of moist air, advanced exactly
`drop_shape`        drops as bodies, and the effects of their surface and of salt dissolved in them
`drop`              the loop over events, with drops
`drop_parcelset`    the box with drops, advanced exactly
"""
