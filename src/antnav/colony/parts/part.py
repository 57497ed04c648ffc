"""Part: a rule and the parameters that it owns."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, ClassVar, Self, dataclass_transform

from antnav.colony.parts.names import Name
from antnav.colony.parts.parameter import Parameter, parameters_of
from antnav.errors import ParameterError, check_type, likely, shown
from antnav.planner.facts import Basis, Knows
from antnav.plugins.loading import HOW, PARTS, sought

if TYPE_CHECKING:
    from collections.abc import Callable

    from antnav.colony.parameters import Settings
    from antnav.plugins.source import Source

Share = dict[str, int | float]


@dataclass_transform(kw_only_default=True, frozen_default=True)
class Part:
    """A frozen choice of one rule with its parameters, given by name and validated.

    Subclasses name the parameters in their bodies; a dataclass of each would cost ten times as much at import.

    Attributes
    ----------
    name : Name
        What users call it.
    basis : Basis
        How sure it is.
    parameters : dict of str to Parameter
    knows : Knows
        Exact distances that it uses.
    no_regions : str
        Why it cannot be used on a graph of regions; empty where it can.
    family, registered : dict of str to type of Part
        Those of antnav of one kind, and those of users, by name.
    role : str
        What it decides, as presets call it: "pheromone", "local_search".
    own : bool
        Whether it is a user's, which has the next three.
    source : Source
    function : callable
        What the rule does; its arguments after the first one, or as many as the kind has, are the parameters.
    jit : bool
        Whether it is to be compiled.
    """

    name: ClassVar[Any]
    basis: ClassVar[Basis]
    parameters: ClassVar[dict[str, Parameter]] = {}
    knows: ClassVar[Knows] = Knows.NOTHING
    no_regions: ClassVar[str] = ""
    family: ClassVar[dict[Name, type[Part]]]
    registered: ClassVar[dict[str, type[Part]]]
    role: ClassVar[str]
    own: ClassVar[bool] = False
    source: ClassVar[Source]
    function: ClassVar[Callable[..., Any]]
    jit: ClassVar[bool] = False

    def __init_subclass__(cls) -> None:
        cls.parameters = parameters_of(cls)
        if Part in cls.__bases__:
            cls.family, cls.registered = {}, {}
            words = (f"_{letter.lower()}" if letter.isupper() else letter for letter in cls.__name__[:-4])
            cls.role = "".join(words)[1:]
        elif isinstance(vars(cls).get("name"), Name):
            cls.family[cls.name] = cls

    def __init__(self, **choices: Any) -> None:
        for name in choices:
            if name not in self.parameters:
                rule = f"its parameters are {', '.join(self.parameters)}" if self.parameters else "it has no parameters"
                raise ParameterError(f"{name} of {self}", rule, "leave it out")
        for name, one in self.parameters.items():
            object.__setattr__(self, name, one.checked(choices.get(name, one.default)))

    @classmethod
    def of(cls, given: Part | type[Part] | str) -> Self:
        """The part of that name with its defaults, or the part itself; its class stands for it with its defaults.

        A name may be that of a user's: a registered one, one that an installed package announces, or "mine.py:name".

        Raises
        ------
        ParameterError
            It is none of this family.
        """
        if isinstance(given, cls):
            return given
        if isinstance(given, type) and issubclass(given, cls) and hasattr(given, "name"):
            return given()
        if isinstance(given, Part) or (isinstance(given, type) and issubclass(given, Part)):
            check_type(cls.role, given, cls, f"choose one of {', '.join(cls.names())}")
        found = sought(given, lambda name: cls.known().get(name), PARTS) if isinstance(given, str) else None
        if found is None:
            near = likely(given, cls.names()) if isinstance(given, str) else ""
            rule, remedy = f"it is one of {', '.join(cls.names())}", f"choose {near or 'one of them'}, {HOW}"
            raise ParameterError(f"{cls.role} {shown(given)}", rule, remedy)
        part: Self = found()  # type: ignore[assignment]
        return part

    @classmethod
    def names(cls) -> list[str]:
        """Names of this family, those of users last."""
        return [*cls.kind(), *cls.registered]

    @classmethod
    def known(cls) -> dict[str, type[Part]]:
        """All of this family by name."""
        return {str(name): part for name, part in cls.family.items()} | cls.registered

    @classmethod
    def kind(cls) -> type[Name]:
        """The names of this family."""
        return type(next(iter(cls.family)))

    def changed(self, **choices: Any) -> Self:
        """The same with some parameters replaced."""
        return type(self)(**(self.values() | choices)) if choices else self

    def values(self) -> dict[str, Any]:
        """Its parameters; vars() would give each part a dictionary of its own for ever."""
        return {name: getattr(self, name) for name in self.parameters}

    def share(self, schedule: int) -> Share:
        """What the kernel has to know of it: fields of `ant_kernels.Choices`, on a schedule of so many iterations."""
        return {}

    def on(self, side: int, algorithm: Settings, *, dear: bool) -> Self | Part:
        """What becomes of it on a map whose longer side has that many cells, which may have costs."""
        return self

    def refuse(self, algorithm: Settings) -> None:
        """Raise a `ParameterError` where the algorithm's other choices do not fit this part."""

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"{type(self).__name__} is frozen: make another with changed()")

    def __delattr__(self, name: str) -> None:
        raise AttributeError(f"{type(self).__name__} is frozen: make another with changed()")

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Part) and self._rule() == other._rule() and self.values() == other.values()

    def __hash__(self) -> int:
        return hash((self._rule(), *self.values().values()))

    def _rule(self) -> type[Part] | Source:
        """Which rule it is; a user's may have been registered more than once."""
        return self.source if self.own else type(self)

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{name}={value!r}' for name, value in self.values().items())})"

    def __str__(self) -> str:
        return str(self.name)
