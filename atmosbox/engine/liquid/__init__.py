"""Condensed water: a reservoir of molecules and energy, as a mist, as drops or as a pool.

`substance`         what condenses, and as what
`reservoir`         the condensed molecules, and the laws of exchange
`insertion`         where a molecule that evaporates finds a free place
`phase`             a molecule leaves the box, or comes into it
`moist_account`     what a box with liquid in it holds
`moist`             from event to event, with a mist or a pool
`moist_parcelset`   the box of moist air, advanced exactly
`drop_shape`        drops as bodies
`curvature`         what the surface of a drop and salt in it change
`drop`              from event to event, with drops
`drop_parcelset`    the box with drops, advanced exactly
"""
