"""What an object says of itself in a few words."""

from __future__ import annotations

from html import escape


class Summarised:
    """Printed, and shown in a notebook, as the table of its ``summary``."""

    @property
    def summary(self) -> dict[str, str]:
        """What it says in a few words, by name."""
        raise NotImplementedError

    def __str__(self) -> str:
        lines = [(name, text.replace("\n", "\n" + 17 * " ")) for name, text in self.summary.items()]
        return "\n".join(f"{name:<16} {text}" for name, text in lines)

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><th>{escape(name)}</th><td>{escape(text).replace(chr(10), '<br>')}</td></tr>"
            for name, text in self.summary.items()
        )
        return f"<table>{rows}</table>"


def percent(share: float) -> str:
    """Never 100 % of less than all."""
    return f"{int(1000 * share) / 10:g} %"
