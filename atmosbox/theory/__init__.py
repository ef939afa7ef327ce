"""Theory: what is expected, to compare with what the box measures.

Every function is a closed form, or the solution of one equation, with its source. None of them is used to move a
molecule. Where an argument is called ``kT`` or ``diameter`` any consistent set of units will do, reduced or SI; where
it is called ``temperature`` or ``pressure`` of the air, the units are K and Pa. An argument for which a law does not
hold, such as a negative pressure or gas so dense that it would freeze, raises ``ValueError``.

=================== ============================================================================================
file                what it computes
=================== ============================================================================================
equation_of_state   by how much the pressure of hard spheres and discs exceeds that of points; their free energy
kinetic_theory      the speeds of molecules, how often they collide, and how they hit and leave walls
diffusion           how two gases mix, how fast, and the entropy of mixing
unlike_gases        diffusion of unlike molecules, with the heat that they carry
simple_fluid        molecules that attract each other, and argon, nitrogen and methane, which they represent
coexistence         the critical point, and the slope of ln p, from measured liquids and vapours
barometric          how the density of a gas decreases with height
hydrostatic         a column of spheres or discs with excluded volume: its density and its temperature
heated_below        air between a warm floor and a cold ceiling: at rest, the adiabat, the onset of motion
environment         the environment of a parcel, and the International Standard Atmosphere
lifting             a parcel that is lifted, or compressed without heat, slowly or fast
humidity            how much water vapour is in the air, at saturation or below
moist_lifting       the cloud base of a lifted parcel, and its temperature with cloud and with rain
cloud_base          the cloud base of a measured ascent
buoyancy            whether a parcel rises by itself, and with what energy
koehler             the vapour pressure over a drop, from its curvature and from the salt in it
evaporation         the equilibrium in which evaporation and condensation end
liquid_rate         the rate and energy of molecules that leave a liquid, large or small
small_box           fluctuations of the number of molecules of vapour in a small box with liquid
=================== ============================================================================================

The public names are those of ``__all__`` in each file.
"""

from atmosbox.theory.barometric import *
from atmosbox.theory.buoyancy import *
from atmosbox.theory.cloud_base import *
from atmosbox.theory.coexistence import *
from atmosbox.theory.diffusion import *
from atmosbox.theory.environment import *
from atmosbox.theory.equation_of_state import *
from atmosbox.theory.evaporation import *
from atmosbox.theory.heated_below import *
from atmosbox.theory.humidity import *
from atmosbox.theory.hydrostatic import *
from atmosbox.theory.kinetic_theory import *
from atmosbox.theory.koehler import *
from atmosbox.theory.lifting import *
from atmosbox.theory.liquid_rate import *
from atmosbox.theory.moist_lifting import *
from atmosbox.theory.simple_fluid import *
from atmosbox.theory.small_box import *
from atmosbox.theory.unlike_gases import *
