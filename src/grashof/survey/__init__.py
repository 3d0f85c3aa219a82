"""All that a linkage does and takes: what `grashof analyse` reports, as tables, facts, pages and plots."""

from grashof.study.asked import Asked
from grashof.study.quantities import Quantity
from grashof.study.section import Fact, Plot, Section
from grashof.survey.report import LinkageReport, report_on

__all__ = ["Asked", "Fact", "LinkageReport", "Plot", "Quantity", "Section", "report_on"]
