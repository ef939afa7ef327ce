"""What temperature is, with four times as many molecules.

The same as `temperature`. The cube is wider, so the molecules take a little longer to become as warm as
the walls; and the thermometer scatters half as much, 9 K for eight hundred molecules: noise falls with
the square root of their number.
"""

title = "What is temperature? More molecules"
level = "school"
minutes = 10
variant_of = "temperature"
defaults = {"molecules": 800}
