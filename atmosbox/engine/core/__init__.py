"""The parts that every engine shares: molecules, walls, laws of contact, tallies.

`state`         what is known of a molecule, of its box, of what lies ahead
`motion`        free flight
`elementary`    logarithms, exponentials and their like, the same bits everywhere
`random`        random numbers
`hard_sphere`   the law of hard spheres: when two touch, what becomes of their velocities
`square_well`   the law of spheres that attract each other: edge and core of a well
`pair`          how far molecules feel each other, when they meet: by whichever law
`schedule`      numbers that change with time
`walls`         what walls do, one law each
`refusal`       the errors
`inputs`        what is refused
`packing`       which part of the space molecules fill
`account`       what a box has counted, and whether its energy adds up
`saved_state`   the state of a box as named arrays and plain numbers, for copies and files
`adjustment`    what may be changed while time passes
`parcel`        the box: what it is given, holds and tells; what may move its piston
`box`           the box, as the kernels know it
`kind`          molecules that are alike
`marching`      the box, advanced in equal time steps
`measure`       what is read off the molecules
`course`        how far along its planned ascent a parcel is
`lift`          a piston that follows a pressure
`jit`           how a kernel is compiled when it is first called
`compiler`      what numba makes of it
`kernel_cache`  where the machine code is kept, and who is told when some is made
`by_reference`  NamedTuples that kernels hand on by reference
`constant_modes`  the flags of a set of modes as constants
"""
