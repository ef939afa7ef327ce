"""`glance` in vector instructions: the numpy code of that file, written for the compiler.

This file is imported when the first kernel is compiled.
"""

import llvmlite.ir as ir
from numba.core import cgutils, types
from numba.extending import intrinsic

__all__ = ["glance_of"]


def glance_of(lanes, tiny):
    """Return `glance` for ``lanes`` copies at once, with the tolerance ``tiny`` for small products."""

    @intrinsic
    def glance(typing_context, values, first, mixed, place, velocity, since, slack, within):
        single = types.float32
        signature = types.int64(
            values, types.int64, types.boolean, types.UniTuple(single, 3), types.UniTuple(single, 3), single,
            types.UniTuple(single, 3), single,
        )  # fmt: skip

        def generate(context, builder, signature, arguments):
            array = context.make_array(signature.args[0])(context, builder, arguments[0])
            vector = ir.VectorType(ir.FloatType(), lanes)
            nothing = ir.Constant(vector, ir.Undefined)
            first_lane = ir.Constant(ir.VectorType(ir.IntType(32), lanes), [0] * lanes)
            zero = ir.Constant(vector, [0.0] * lanes)
            fused = cgutils.get_or_insert_function(
                builder.module, ir.FunctionType(vector, [vector] * 3), f"llvm.fmuladd.v{lanes}f32"
            )

            def spread(value):
                one = builder.insert_element(nothing, value, ir.Constant(ir.IntType(32), 0))
                return builder.shuffle_vector(one, nothing, first_lane)

            def part(which, k):
                return spread(builder.extract_value(arguments[which], k))

            def load(k):
                place = builder.gep(array.data, [builder.add(arguments[1], ir.Constant(ir.IntType(64), k * lanes))])
                value = builder.load(builder.bitcast(place, vector.as_pointer()))
                value.align = 4
                return value

            def product(a, b, start=None):
                total = builder.fmul(a[0], b[0]) if start is None else builder.call(fused, [a[0], b[0], start])
                for k in (1, 2):
                    total = builder.call(fused, [a[k], b[k], total])
                return total

            since, within = spread(arguments[5]), spread(arguments[7])
            speed = [load(3 + k) for k in range(3)]
            r = [builder.call(fused, [speed[k], since, builder.fsub(load(k), part(3, k))]) for k in range(3)]
            v = [builder.fsub(speed[k], part(4, k)) for k in range(3)]
            reach = part(6, 0)
            reach = builder.select(arguments[2], builder.fadd(reach, load(6)), reach)
            square = builder.call(fused, [reach, reach, part(6, 1)])
            b, a, c = product(r, v), product(v, v), product(r, r, builder.fneg(square))
            granted = ir.Constant(vector, [tiny] * lanes)
            # each comparison is also true for NaN
            near = builder.fcmp_unordered("<=", builder.fmul(a, c), builder.call(fused, [b, b, granted]))
            approach = builder.fcmp_unordered("<", b, part(6, 2))
            turn = builder.call(fused, [a, within, b])
            soon = builder.or_(
                builder.fcmp_unordered(">", turn, zero),
                builder.fcmp_unordered("<", builder.call(fused, [within, builder.fadd(b, turn), c]), zero),
            )
            found = builder.and_(builder.and_(near, approach), soon)
            return builder.zext(builder.bitcast(found, ir.IntType(lanes)), ir.IntType(64))

        return signature, generate

    return glance
