"""A parcel of air that rises under its piston: the common parts of the scenes with lifted air."""
