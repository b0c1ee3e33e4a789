"""The conformance suite that all shipped methods pass and that a third party runs on a method of its own."""

from harness.conformance.suite import ConformanceCheck as ConformanceCheck
from harness.conformance.suite import checks as checks
from harness.conformance.suite import conforms as conforms
from harness.conformance.suite import suite as suite
