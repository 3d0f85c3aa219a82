"""The analysis of a linkage that `grashof analyse` reports: tables, facts, sections with plots."""

from grashof.study.asked import Asked
from grashof.study.quantities import Quantity
from grashof.study.section import Fact, Plot, Section
from grashof.survey.report import LinkageReport, report_on

__all__ = ["Asked", "Fact", "LinkageReport", "Plot", "Quantity", "Section", "report_on"]
