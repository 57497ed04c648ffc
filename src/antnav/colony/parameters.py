"""An algorithm as a frozen choice of parts and parameters, validated."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from functools import cache
from typing import Any, Self

from antnav.colony.parts import (
    Axis,
    Cuts,
    CutsPart,
    DeadlockPart,
    Deposit,
    HeuristicPart,
    InitialPart,
    Join,
    Keep,
    LocalSearchPart,
    MemoryPart,
    Parameter,
    Part,
    PheromonePart,
    Roulette,
    Search,
    TransitionPart,
    Uniform,
    Unsearched,
    parameter,
    parameters_of,
)
from antnav.errors import ParameterError, check_type, shown
from antnav.planner.facts import Basis, Certainty, Clause, Knows
from antnav.plugins.loading import divided
from antnav.plugins.source import Source
from antnav.world.grid import GridMap
from antnav.world.problem import Problem


def _check(choices: object) -> None:
    """Validate all parameters of a dataclass."""
    for name, one in parameters_of(type(choices)).items():
        given = getattr(choices, name)
        kept = one.checked(given)
        if kept is not given:
            object.__setattr__(choices, name, kept)


class _Cutting(Parameter):
    """`Cuts`, or a user's."""

    __slots__ = ()

    def checked(self, value: Any) -> Cuts | CutsPart:
        return Cuts(value) if isinstance(value, str) and value in [*Cuts] else CutsPart.of(value)


CUTTING: Any = _Cutting(Cuts.LINE, 0, 0, above=False, zero=False, sane=None, symbol="", certainty=Basis.PAPER)


@dataclass(frozen=True, kw_only=True)
class Decomposition:
    """PACO's division of the map at an auxiliary cell (sections 4.3, 4.4).

    Parameters
    ----------
    stage_one : int
        T0, iterations of the two colonies that look for the auxiliary cell, >= 1; default 3 [paper]. Sane: 2 to 10.
    axis : {"auto", "row", "column"}
        Dividing line; see `Axis`. "auto" is the paper's rule, "row" what its figures show.
    search : {"whole", "half"}
        Where stage two walks; see `Search`. "whole" [paper], "half" [ours].
    inherit : bool
        Whether stage two starts from the pheromone of stage one [ours]; default False: from fresh pheromone [paper].
    join : {"paper", "repair"}
        How the sub-paths become one; see `Join`.
    cuts : {"line", "levels"}, or a part of your own
        What divides the map; see `Cuts` and `antnav.register.cuts`.
    pieces : int
        K, pieces of stage two, 2 to 64; default 2 [paper]; more with levels [ours]. Sane: 2 to 8.
    """

    stage_one: int = parameter(3, least=1, sane=(2, 10), symbol="T0", certainty=Basis.PAPER)
    axis: Axis = parameter(Axis.AUTO, certainty=Basis.PAPER)
    search: Search = parameter(Search.WHOLE, certainty=Basis.PAPER)
    inherit: bool = parameter(False, certainty=Basis.PAPER)
    join: Join = parameter(Join.PAPER, certainty=Basis.PAPER)
    cuts: Cuts | CutsPart = CUTTING
    pieces: int = parameter(2, least=2, most=64, sane=(2, 8), symbol="K", certainty=Basis.PAPER)

    def __post_init__(self) -> None:
        _check(self)
        if self.pieces > 2 and self.cuts is Cuts.LINE:
            raise ParameterError(f"pieces {self.pieces} with cuts line", "a line makes two", "give cuts levels")
        if isinstance(self.cuts, CutsPart) and self.search is Search.HALF:
            rule = "your own cuts are nodes, which have no sides"
            raise ParameterError(f"search half with cuts {self.cuts}", rule, "give search whole")

    def choices(self) -> dict[str, Any]:
        """Its parameters, and those of a user's cuts."""
        return dict(vars(self)) | (
            {"cuts": str(self.cuts), **self.cuts.values()} if isinstance(self.cuts, CutsPart) else {}
        )

    @classmethod
    def of(cls, document: Mapping[str, Any]) -> Self:
        """The one of a document."""
        kept = {name: document[name] for name in _SPLIT if name in document}
        if "cuts" in kept and kept["cuts"] not in [*Cuts]:
            kept["cuts"] = _read(CutsPart, "cuts", kept["cuts"], document)
        return cls(**kept)

    def changed(self, choices: Mapping[str, Any]) -> Self:
        """The same with those of these choices replaced that are its or its cuts'."""
        found = {name: value for name, value in choices.items() if name in _SPLIT}
        cuts = CUTTING.checked(found.get("cuts", self.cuts))
        if isinstance(cuts, CutsPart):
            found["cuts"] = cuts.changed(**{name: choices[name] for name in cuts.parameters if name in choices})
        return replace(self, **found) if found else self


#: The kinds of parts that own parameters, by the field of `Settings` that holds them.
FAMILIES: dict[str, type[Part]] = {
    "heuristic": HeuristicPart,
    "pheromone": PheromonePart,
    "deadlock": DeadlockPart,
    "transition": TransitionPart,
    "initial": InitialPart,
    "memory": MemoryPart,
    "local_search": LocalSearchPart,
}
#: All kinds of rules that may be a user's: those, and the cuts of a `Decomposition`.
RULES: dict[str, type[Part]] = {**FAMILIES, "cuts": CutsPart}
#: Default of every parameter that a part owns, whichever it is.
OWNED = {
    name: one.default
    for family in FAMILIES.values()
    for part in family.family.values()
    for name, one in part.parameters.items()
}
_SPLIT = parameters_of(Decomposition)


def owned_by_users() -> dict[str, list[tuple[str, str]]]:
    """The parameters of users' registered parts, with kind and name of each part that has one."""
    found: dict[str, list[tuple[str, str]]] = {}
    for kind, family in RULES.items():
        for part, owner in family.registered.items():
            for name in owner.parameters:
                found.setdefault(name, []).append((kind, part))
    return found


#: Choices that do not make an algorithm another: how much it runs, how it is called, the axis that the paper varies.
_FREE = {"name", "certainty", "ants", "iterations", "axis", "straighten"}


@dataclass(frozen=True, kw_only=True)
class Settings:
    """An ant algorithm, composed of parts.

    Parts own the parameters that only they need: `algorithm.pheromone.elite` where the rule is `RankBased`. In presets,
    study files and documents these stand beside the others, by names that no two parts share for different things.

    Parameters
    ----------
    name : str
        For reports.
    ants : int
        m, ants an iteration, >= 1; default 50 [paper]. Sane: 10 to 200.
    iterations : int
        T, >= 1; default 50 [paper]. Sane: 20 to 500.
    alpha : float
        Weight of the pheromone, >= 0; default 1 [paper]. Sane: 0.5 to 3. Runs with whole alpha and beta give the same
        bytes on every machine; other powers depend on the mathematical library.
    beta : float
        Weight of the heuristic, >= 0; default 7 [paper]. Sane: 1 to 12; larger is greedier.
    rho : float
        Evaporation rate in [0, 1]; default 0.1 [calibrated; not printed in the paper]. Sane: 0.02 to 0.5.
    q : float
        Q, pheromone of one deposit, > 0; default 1 [paper].
    tau0 : float
        Initial pheromone, > 0; default 1 [calibrated].
    tau_min : float
        Lower bound of the pheromone as a share of tau0, in (0, 1]; default 0.001 [calibrated: eq. (4.1) can make it
        negative, which the paper leaves open].
    heuristic, pheromone, deadlock, transition, initial, memory, local_search : part, or its name
        With a name, the part has its own defaults. Default "roulette", "uniform" and "none" [paper], "keep" [ours]; the
        others have to be given.
    deposit : Deposit
        Default "both" [calibrated].
    decomposition : Decomposition or None
        None: one colony on the whole map.
    coarse : int
        Side in cells of the blocks of an abstraction whose graph of regions the ants walk on, 4 to 128; 0 (default):
        they walk on the cells [ours]. Sane: 8 to 32. See `abstraction`.
    routes : int
        With `coarse`: how many of the ants' routes are laid out on cells, >= 1; default 1 [ours]. Sane: 1 to 8.
    windows : int
        Moves of the windows in which the path found is searched anew, exactly, >= 3; 0 (default): none [ours]. Where
        cells or turns cost, 192 at most. See `windows`. Sane: 30 to 1000.
    straighten : bool
        Whether the path found gets fewer turns by another order of its moves, at exactly its length [ours]; False shows
        the raw path. See `windows.straightened`.
    graft : bool
        Whether each arrived ant gives its shorter pieces to the best path so far; default False [ours].
    colonies : int
        Colonies that run side by side on the whole map for the whole schedule, by turns from the start and from the
        goal; the best path wins. 1 to 64; default 1 [ours]. Sane: 1 to 4.
    rho_last, beta_last : float or None
        Values of rho and beta at the last iteration, reached linearly; None (default): they stay. A beta that changes
        uses powers, which differ in the last digit between machines.
    openness : float
        Exponent >= 0 on the share of free neighbours of a cell, a factor of eta; default 0: none. Sane: 0 to 3.
    spread : float
        Share in [0, 1] of each deposit that also goes to all edges into the cells of the path; default 0. Sane: 0 to
        0.3.
    local_rate : float
        xi in [0, 1] of the Ant Colony System's local update, tau <- (1 - xi) tau + xi tau0 at each step, with any
        transition rule; default 0.
    certainty : Certainty or str
        How sure it is that this is what its source describes. What the parts know is added to it.

    Raises
    ------
    ParameterError
        A value out of its range, or parts that do not fit together.
    """

    name: str
    heuristic: HeuristicPart
    pheromone: PheromonePart
    deadlock: DeadlockPart
    deposit: Deposit = parameter(Deposit.BOTH, certainty=Basis.CALIBRATED)
    decomposition: Decomposition | None = None
    coarse: int = parameter(0, least=4, most=128, zero=True, sane=(8, 32), certainty=Basis.OURS)
    routes: int = parameter(1, least=1, sane=(1, 8), certainty=Basis.OURS)
    windows: int = parameter(0, least=3, most=10_000, zero=True, sane=(30, 1000), certainty=Basis.OURS)
    straighten: bool = parameter(True, certainty=Basis.OURS)
    ants: int = parameter(50, least=1, sane=(10, 200), symbol="m", certainty=Basis.PAPER)
    iterations: int = parameter(50, least=1, sane=(20, 500), symbol="T", certainty=Basis.PAPER)
    alpha: float = parameter(1.0, most=20, sane=(0.5, 3), symbol="alpha", certainty=Basis.PAPER)
    beta: float = parameter(7.0, most=60, sane=(1, 12), symbol="beta", certainty=Basis.PAPER)
    rho: float = parameter(0.1, most=1, sane=(0.02, 0.5), symbol="rho", certainty=Basis.CALIBRATED)
    q: float = parameter(1.0, most=1e6, above=True, symbol="Q", certainty=Basis.PAPER)
    tau0: float = parameter(1.0, most=1e6, above=True, symbol="tau0", certainty=Basis.CALIBRATED)
    tau_min: float = parameter(1e-3, most=1, above=True, certainty=Basis.CALIBRATED)
    local_search: LocalSearchPart = Unsearched()
    graft: bool = parameter(False, certainty=Basis.OURS)
    colonies: int = parameter(1, least=1, most=64, sane=(1, 4), certainty=Basis.OURS)
    rho_last: float | None = parameter(None, most=1)
    beta_last: float | None = parameter(None, most=60)
    openness: float = parameter(0.0, most=20, sane=(0, 3))
    spread: float = parameter(0.0, most=1, sane=(0, 0.3))
    transition: TransitionPart = Roulette()
    local_rate: float = parameter(0.0, most=1, symbol="xi")
    initial: InitialPart = Uniform()
    memory: MemoryPart = Keep()
    certainty: Certainty = Certainty.of("own composition")

    def __post_init__(self) -> None:
        for kind, family in FAMILIES.items():
            object.__setattr__(self, kind, family.of(getattr(self, kind)))
        _check(self)
        if not (self.decomposition is None or isinstance(self.decomposition, Decomposition)):
            raise ParameterError(
                f"decomposition {shown(self.decomposition)}",
                "it is None or a Decomposition",
                "give axis, search, ... by name",
            )
        self._check_together()
        known = _known(self.knows, self.heuristic)
        known += tuple(Clause(Basis.OWN, f"own rule {part.source}") for part in self.own)
        certainty = Certainty.of(self.certainty).with_known(known)
        object.__setattr__(self, "certainty", certainty)

    @property
    def parts(self) -> dict[str, Part]:
        """The parts that own parameters, by kind."""
        return {kind: getattr(self, kind) for kind in FAMILIES}

    @property
    def own(self) -> list[Part]:
        """Those of its parts that are users'."""
        return [part for part in self._rules().values() if part.own]

    def _rules(self) -> dict[str, Part]:
        """All parts by kind, those of its decomposition too."""
        cuts = self.decomposition and self.decomposition.cuts
        return self.parts | ({"cuts": cuts} if isinstance(cuts, CutsPart) else {})

    @property
    def rates(self) -> set[float]:
        """Rates of evaporation at the first and at the last iteration."""
        return {self.rho, self.rho if self.rho_last is None else self.rho_last}

    @property
    def knows(self) -> Knows:
        """Exact distances that it uses; those of an "auto" heuristic only once the problem is known, see `suited`."""
        found = self.heuristic.knows
        if found and self.coarse:
            found = Knows.REGIONS
        found |= self.memory.knows | self.initial.knows | self.local_search.knows
        if self.decomposition is not None:
            cuts = self.decomposition.cuts
            found |= cuts.knows if isinstance(cuts, CutsPart) else Knows.FROM_START if cuts is Cuts.LEVELS else Knows(0)
        return found | Knows.WINDOWS if self.windows else found

    def _check_together(self) -> None:
        """Refuse what does not fit together, with the reason."""
        split = self.decomposition
        if split is not None and split.stage_one >= self.iterations:
            raise ParameterError(
                f"stage_one {split.stage_one}",
                f"stage one is shorter than the run of {self.iterations} iterations",
                "give fewer iterations to stage one or more to the run",
            )
        if self.colonies > 1 and (split is not None or self.coarse):
            raise ParameterError(
                f"colonies {self.colonies} with {'coarse' if self.coarse else 'a decomposition'}",
                "it says how many colonies walk from one end of the whole way to the other; stages have their own",
                "leave one of them out",
            )
        if self.coarse:
            self._check_coarse()
        for part in self.parts.values():
            part.refuse(self)
        if self.beta_last is not None and self.beta == 0:
            raise ParameterError(
                "beta_last with beta 0", "beta changes in proportion to its first value", "give beta, such as 7"
            )

    @property
    def searches(self) -> bool:
        """Whether paths are bettered after the walk, which takes kernels of its own."""
        return self.graft or self.local_search != Unsearched()

    def _check_coarse(self) -> None:
        """Refuse what a graph of regions cannot carry."""
        parts = {f"{kind.replace('_', ' ')} {part}": part for kind, part in self.parts.items()}
        reasons = {given: part.no_regions for given, part in parts.items() if part.no_regions}
        if self.decomposition is not None:
            reasons = {"a decomposition": "regions divide the map already"} | reasons
        for given, reason in reasons.items():
            raise ParameterError(f"coarse {self.coarse} with {given}", reason, "leave one of them out")

    def on(self, grid: GridMap) -> Self:
        """`suited` to problems on a map without costs."""
        return self._on(max(grid.shape), dear=False)

    def suited(self, problem: Problem) -> Self:
        """The same algorithm with the choices made that depend on the problem: `switch` and an "auto" heuristic."""
        return self._on(max(problem.grid.shape), dear=problem.objective.field is not None)

    def _on(self, side: int, *, dear: bool) -> Self:
        parts: dict[str, Any] = {kind: part.on(side, self, dear=dear) for kind, part in self.parts.items()}
        made = {kind: part for kind, part in parts.items() if part is not getattr(self, kind)}
        return replace(self, **made) if made else self

    def choices(self) -> dict[str, Any]:
        """Every choice by its flat name: fields, parts by their names, the parameters that these and a division own."""
        flat = {field.name: getattr(self, field.name) for field in fields(self) if field.name != "decomposition"}
        for kind, part in self.parts.items():
            flat |= {kind: str(part) if part.own else part.name, **part.values()}
        flat["certainty"] = str(flat.pop("certainty"))
        return flat | (self.decomposition.choices() if self.decomposition else {})

    def document(self) -> dict[str, Any]:
        """What files keep: every choice by its flat name, a part's parameter at its default where the part is another.

        See Also
        --------
        of : the way back
        """
        split = self.decomposition.choices() if self.decomposition else {}
        flat = {name: value for name, value in self.choices().items() if name not in split}
        flat["decomposition"] = split or None
        flat |= {name: default for name, default in OWNED.items() if name not in flat}
        own = {kind: part.source.document() for kind, part in self._rules().items() if part.own}
        return flat | ({"own": own} if own else {})

    @classmethod
    def of(cls, document: Mapping[str, Any]) -> Self:
        """The algorithm of a document. What none of its parts owns is passed over.

        Raises
        ------
        ParameterError
            A choice is missing or out of its range.
        """
        check_type("algorithm", document, Mapping, "give its choices by name")
        kept = {field.name: document[field.name] for field in fields(cls) if field.name in document}
        for name in ("name", *FAMILIES, "certainty"):
            value = kept.get(
                name, "" if name in ("transition", "initial", "memory", "local_search", "certainty") else None
            )
            check_type(name, value, str, "give a text")
        for kind, family in FAMILIES.items():
            if kind in kept:
                kept[kind] = _read(family, kind, kept[kind], document)
        if kept.get("decomposition") is not None:
            split = kept["decomposition"]
            check_type("decomposition", split, dict, "give its parameters by name")
            kept["decomposition"] = Decomposition.of(split)
        made = cls(**kept)
        stated = "; ".join(map(str, made.certainty.clauses))
        rules = [f"own rule {Source.read(told)}" for told in dict(document.get("own", {})).values()]
        for clause in (*map(str, made.certainty.known), *rules):  # was printed behind what was stated
            stated = stated.replace(f"; {clause}", "")
        return replace(made, certainty=Certainty.of(stated))

    @staticmethod
    def can_be_made(document: Mapping[str, Any]) -> bool:
        """Whether all users' rules that a document names are registered here, or announced by a package."""
        check_type("own", own := document.get("own", {}), dict, "leave it out")
        split = document.get("decomposition")
        for kind, family in RULES.items():
            if kind in own:
                name = (split if isinstance(split, dict) else {}).get(kind) if kind == "cuts" else document.get(kind)
                check_type(kind, name, str, "give a text")
                try:
                    family.of(divided(str(name))[1])
                except ParameterError:
                    return False
        return True

    def changed(self, **choices: Any) -> Self:
        """The same with some choices replaced, by their flat names; its certainty tells what was modified.

        A part given by name has its own defaults, unless it is there already.

        Raises
        ------
        ParameterError
            A value out of its range, a parameter whose part the algorithm does not have, or parts that do not fit.
        """
        if not choices:
            return self
        parts = self._chosen_parts(choices)
        in_split = {*_SPLIT, *self._of_cuts(choices)}
        owned = OWNED.keys() | owned_by_users().keys() | {name for part in parts.values() for name in part.parameters}
        owned -= in_split
        known = {field.name for field in fields(self)} | owned | (in_split if self.decomposition else set())
        if unknown := sorted(choices.keys() - known):
            rule = f"{self.name} has {', '.join(sorted({*self.choices(), 'decomposition'}))}"
            raise ParameterError(f"parameter {unknown[0]!r}", rule, "choose one of them")
        kept = {name: value for name, value in choices.items() if name not in owned and name not in in_split}
        kept |= _with_parameters(parts, {name: value for name, value in choices.items() if name in owned})
        if split := choices.keys() & in_split:
            whole = choices.get("decomposition", self.decomposition)
            if not isinstance(whole, Decomposition):
                raise ParameterError(
                    f"{min(split)} with decomposition {shown(whole)}",
                    "it belongs to a Decomposition",
                    "leave one of them out",
                )
            kept["decomposition"] = whole.changed(choices)
        made = replace(self, **kept)
        changes = "" if "certainty" in choices else _changes(self, made)
        return replace(made, certainty=made.certainty.modified(changes)) if changes else made

    def _of_cuts(self, choices: Mapping[str, Any]) -> Mapping[str, Any]:
        """Parameters of a user's cuts, among the choices or there already."""
        given = choices.get("cuts", self.decomposition and self.decomposition.cuts)
        cuts = None if given is None else CUTTING.checked(given)
        return cuts.parameters if isinstance(cuts, CutsPart) else {}

    def _chosen_parts(self, choices: Mapping[str, Any]) -> dict[str, Part]:
        """The parts among the choices, and its own of the other kinds."""
        parts = {}
        for kind, part in self.parts.items():
            given = choices.get(kind, part)
            parts[kind] = part if isinstance(given, str) and given == part.name else FAMILIES[kind].of(given)
        return parts


def _read(family: type[Part], kind: str, name: str, document: Mapping[str, Any]) -> Part:
    """The part of a document; a file that its name tells of is not executed."""
    if divided(name)[0]:
        rule = "what a document names is registered: reading one executes no file"
        raise ParameterError(f"{kind} {shown(name)}", rule, "give the name alone")
    part = family.of(name)
    return part.changed(**{own: document[own] for own in part.parameters if own in document})


def _with_parameters(parts: Mapping[str, Part], owned: Mapping[str, Any]) -> dict[str, Part]:
    """The parts with these parameters."""
    made = {
        kind: part.changed(**{name: value for name, value in owned.items() if name in part.parameters})
        for kind, part in parts.items()
    }
    for name, value in owned.items():
        if not any(name in part.parameters for part in parts.values()):
            kind, owners = _owners(name)
            raise ParameterError(
                f"{name} {shown(value)} with {kind} {parts.get(kind, 'of another kind')}",
                f"{name} belongs to {kind} {' or '.join(owners)}",
                f'leave it out, or give {kind}="{owners[0]}"',
            )
    return made


def _owners(name: str) -> tuple[str, list[str]]:
    """The kind and the names of the parts that own a parameter."""
    owners = {
        kind: [str(part) for part, owner in family.known().items() if name in owner.parameters]
        for kind, family in RULES.items()
    }
    return next((kind, parts) for kind, parts in owners.items() if parts)


def _changes(before: Settings, after: Settings) -> str:
    """What was changed of a published algorithm, as text."""
    made = after.choices()
    usual = OWNED | {name: one.default for part in after.own for name, one in part.parameters.items()}
    usual |= before.choices()
    if bool(before.decomposition) != bool(after.decomposition):
        made = {name: value for name, value in made.items() if name not in _SPLIT}
    changes = [f"{name} {value}" for name, value in made.items() if name not in _FREE and usual[name] != value]
    if bool(before.decomposition) != bool(after.decomposition):
        changes.append("decomposition")
    return ", ".join(changes)


@cache
def _known(knows: Knows, heuristic: HeuristicPart) -> tuple[Clause, ...]:
    """What an algorithm knows or estimates beside its ants, as clauses of its certainty; many results share these."""
    words = {Knows.FROM_START: "the cuts know exact distances", Knows.WINDOWS: "windows are searched exactly"}
    words[Knows.GAPS] = "gaps of remembered paths are searched exactly"
    words[Knows.WOVEN] = "cells that ants have visited are searched exactly"
    found = [words[one] for one in words if one in knows]
    known = [Clause(Basis.EXACT, ", ".join(found))] if found else []
    if heuristic.knows:
        where = " on the graph of regions" if Knows.REGIONS in knows else ""
        known.append(Clause(heuristic.basis, f"it knows the exact distances{where}", f"heuristic {heuristic}"))
    elif heuristic.estimates:
        known.append(Clause(heuristic.basis, heuristic.estimates, f"heuristic {heuristic}"))
    return tuple(known)
