"""The parts that every engine shares: molecules, walls, collision laws, tallies.

`state`         the data of molecules, box and events, as NamedTuples of arrays
`motion`        free flight
`elementary`    logarithms, exponentials and the like, with the same bits on every machine
`random`        random numbers
`hard_sphere`   hard spheres: when two of them touch, and their velocities after the collision
`square_well`   spheres that attract each other: the core and the edge of a square well
`pair`          the interface to the pair laws: range, time of meeting, change of velocity
`schedule`      numbers that change with time
`walls`         the laws of the walls, one each
`refusal`       the errors
`inputs`        checks of the numbers that a box is given
`packing`       packing fraction: the part of the space that molecules fill
`account`       the tallies of a box, the terms of its energy budget, and whether it closes
`saved_state`   the state of a box as named arrays and plain numbers, for copies and files
`adjustment`    changes by hand during a run: piston, heat baths, gravity
`parcel`        the box: its parameters, its state, and the driver of its piston
`kind`          kinds: molecules of equal mass, size and rotation
`marching`      a box that is advanced in equal time steps
`measure`       temperature, layers, speeds and mean free path, computed from the molecules
`lift`          a piston that follows a pressure on a planned ascent
`jit`           how a kernel is compiled when it is first called
`compiler`      how numba compiles a kernel: all that goes beyond its documented interface
`kernel_cache`  where the machine code is kept, and reports of compilations
"""
