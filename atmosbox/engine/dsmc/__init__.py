"""Direct simulation Monte Carlo: free flight, then collisions with partners drawn at random from the same cell.

`columns`             many molecules as a structure of arrays, sorted into cells
`streaming`           a step of free flight, with wall hits on the way
`pairing`             which molecules of a cell collide
`moist_columns`       the events of liquid in a step: of a mist, and of a pool
`dsmc`                one time step
`dsmc_parcel`         the box, advanced by this method
`moist_dsmc_parcel`   the box of moist air, advanced by this method
"""
