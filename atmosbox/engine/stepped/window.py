"""A test of eight neighbours at once: which of them are within reach.

Most molecules have no neighbour within reach, and to find that out is most of the work of a step. The processor
compares eight single-precision numbers in one instruction. The result is only a hint: exact arithmetic then decides.
"""

import llvmlite.ir as ir
import numpy as np
from numba.core import types
from numba.extending import intrinsic

from atmosbox.engine.core.jit import COMPILED

__all__ = ["LANES", "within"]

LANES = 8
"""Number of neighbours tested together; arrays must be readable that far beyond their last molecule."""

if COMPILED:

    @intrinsic
    def within(typing_context, x, y, z, radius, first, at_x, at_y, at_z, reach):
        """Return which of the records ``first`` to ``first + LANES - 1`` are within reach of a point.

        Parameters
        ----------
        x, y, z : (record,)
            Coordinates of the neighbours, float32 [length].
        radius : (record,)
            What each neighbour adds to the reach, float32 [length]; None if that is the same for all.
        first
            The first record tested.
        at_x, at_y, at_z, reach
            The point and the reach [length].

        Returns
        -------
        int64
            Bit k is set if record ``first + k`` is within reach.
        """
        alone = isinstance(radius, types.NoneType)
        signature = types.int64(x, y, z, radius, types.int64, *[types.float32] * 4)

        def generate(context, builder, signature, arguments):
            vector = ir.VectorType(ir.FloatType(), LANES)
            nothing = ir.Constant(vector, ir.Undefined)
            first_lane = ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES)

            def spread(value):
                one = builder.insert_element(nothing, value, ir.Constant(ir.IntType(32), 0))
                return builder.shuffle_vector(one, nothing, first_lane)

            def load(which):
                array = context.make_array(signature.args[which])(context, builder, arguments[which])
                place = builder.gep(array.data, [arguments[4]])
                value = builder.load(builder.bitcast(place, vector.as_pointer()))
                value.align = 4
                return value

            squared = None
            for axis in range(3):
                apart = builder.fsub(load(axis), spread(arguments[5 + axis]))
                term = builder.fmul(apart, apart)
                squared = term if squared is None else builder.fadd(squared, term)
            reach = spread(arguments[8])
            if not alone:
                reach = builder.fadd(reach, load(3))
            near = builder.fcmp_ordered("<", squared, builder.fmul(reach, reach))
            return builder.zext(builder.bitcast(near, ir.IntType(LANES)), ir.IntType(64))

        return signature, generate

else:

    def within(x, y, z, radius, first, at_x, at_y, at_z, reach):
        """Return which of ``LANES`` records are within reach of a point."""
        some = slice(int(first), int(first) + LANES)
        total = reach if radius is None else reach + radius[some]
        squared = (x[some] - at_x) ** 2 + (y[some] - at_y) ** 2 + (z[some] - at_z) ** 2
        return sum(1 << lane for lane in np.flatnonzero(squared < total * total).tolist())
