"""Temperature, with four times as many molecules.

This is `temperature` in a wider cube, so the molecules take a little longer to become as warm as the walls. The
thermometer scatters half as much, by 9 K for eight hundred molecules: the scatter falls as one over the square root of
their number.

Modelled: hard spheres of the mass and the diameter of air, which leave the walls with random velocities. Left out:
gravity, rotation, and the different molecules of air.
"""

title = "What is temperature? More molecules"
level = "school"
minutes = 10
variant_of = "temperature"
defaults = {"molecules": 800}
