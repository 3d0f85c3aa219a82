"""All that a linkage does and takes: what `grashof analyse` reports, as tables, facts, pages and plots."""

from grashof.survey.facts import Fact
from grashof.survey.quantities import Quantity
from grashof.survey.report import LinkageReport, report_on

__all__ = ["Fact", "LinkageReport", "Quantity", "report_on"]
