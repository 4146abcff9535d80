"""Names as VTK writes them."""


def camel_case(name: str) -> str:
    """ "PairDistance" of "pair_distance"."""
    return "".join(word[0].upper() + word[1:] for word in name.split("_"))
