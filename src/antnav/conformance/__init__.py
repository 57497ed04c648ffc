"""The conformance suite: what every rule, planner and algorithm of a user's must do, checked one by one."""

from antnav.conformance.model import Conformance, Finding, Verdict
from antnav.conformance.running import check_rules

__all__ = ["Conformance", "Finding", "Verdict", "check_rules"]
