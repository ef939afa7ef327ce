"""NamedTuples that kernels pass on by reference: the compiled version of `jit.by_reference`."""

from typing import Any

from numba.core import cgutils, types
from numba.core.imputils import lower_getattr_generic
from numba.core.typing.templates import AttributeTemplate, infer_getattr
from numba.extending import intrinsic, models, register_model

__all__ = ["by_reference"]

_NAMED = (types.containers.NamedTuple, types.containers.NamedUniTuple)


class Reference(types.Type):
    """The numba type of a NamedTuple that kernels pass on by its address, not value by value."""

    def __init__(self, bundle: Any) -> None:
        self.bundle = bundle
        super().__init__(name=f"reference({bundle})")


@register_model(Reference)
class _ReferenceModel(models.PrimitiveModel):  # type: ignore[misc]
    def __init__(self, manager: Any, kind: Reference) -> None:
        super().__init__(manager, kind, manager.lookup(kind.bundle).get_value_type().as_pointer())


@infer_getattr
class _FieldsOfReference(AttributeTemplate):  # type: ignore[misc]
    key = Reference

    def generic_resolve(self, kind: Reference, name: str) -> Any:
        if name not in kind.bundle.fields:
            return None
        field = kind.bundle.types[kind.bundle.fields.index(name)]
        return Reference(field) if isinstance(field, _NAMED) else field


@lower_getattr_generic(Reference)
def _field_of_reference(context: Any, builder: Any, kind: Reference, value: Any, name: str) -> Any:
    index = kind.bundle.fields.index(name)
    place = cgutils.gep_inbounds(builder, value, 0, index)
    return place if isinstance(kind.bundle.types[index], _NAMED) else builder.load(place)


@intrinsic
def by_reference(typing_context, bundle):
    """Return a NamedTuple as a reference to it: see `jit.by_reference`."""
    signature = Reference(bundle)(bundle)

    def generate(context, builder, signature, arguments):
        return cgutils.alloca_once_value(builder, arguments[0])

    return signature, generate
