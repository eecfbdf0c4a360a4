"""All reports: their titles and introductions, and the modules with their figures and claims."""

from __future__ import annotations

from rocking.papers.report.paper import Paper

YIM_LIN_1991 = Paper(
    name="yim-lin-1991",
    subject="Yim & Lin (1991): figures and claims",
    title="Yim & Lin (1991), recomputed",
    lead="""\
All figures and claims of S. C. S. Yim and H. Lin, Nonlinear impact and chaotic response of slender rocking objects,
J. Eng. Mech. ASCE 117 (1991), recomputed with rocking {version}. Each verdict was computed when this report was generated. The claims
are paraphrased; their numbers and locations are those of the paper. The explanations after a verdict are written by hand. If the
computation does not support an explanation, the verdict is “not confirmed”.""",
    source="the paper",
    modules=("yim_lin_1991.figures", "yim_lin_1991.tables", "yim_lin_1991.beyond"),
    claims=(
        "yim_lin_1991.claims.responses",
        "yim_lin_1991.claims.theory",
        "yim_lin_1991.claims.damping",
        "yim_lin_1991.claims.braced",
    ),
    page_cost=5.2,
)
PULSES_AND_EARTHQUAKES = Paper(
    name="pulses-and-earthquakes",
    subject="Housner (1963) to Makris & Konstantinidis (2003): pulses and earthquakes",
    title="The rocking block under pulses and earthquakes, recomputed",
    lead="""\
Formulas and numbers of Housner (1963), Shi et al. (1996), Makris & Roussos (2000), Zhang & Makris (2001) and Makris & Konstantinidis
(2003), recomputed with rocking {version}. They are those of the slender block or, where a row says so, of the full equation of motion.
Each verdict was computed when this report was generated. The claims are paraphrased; their numbers and locations are those of the papers.
The explanations after a verdict are written by hand. If the computation does not support an explanation, the verdict is “not confirmed”.
Rows that need a record which does not come with the package are not judged. e is the ratio of the velocities after and before an impact.
A = a/(gθcr) is the normalised acceleration, Ω the frequency of a pulse over the frequency parameter of the block.""",
    source="the papers",
    modules=("pulses_and_earthquakes.figures",),
    claims=("pulses_and_earthquakes.claims.pulses", "pulses_and_earthquakes.claims.earthquakes"),
    page_cost=1.6,
)
PAPERS = {paper.name: paper for paper in (YIM_LIN_1991, PULSES_AND_EARTHQUAKES)}
"""Reports by name. The first is the default of the command."""
