"""Every level and threshold by which something is called significant, close or clear.

What a text says of one in words stands beside it.
"""

#: Level of significance of the paper's tests, and of ours; so many false alarms there are.
SIGNIFICANCE, ONE_IN_TWENTY = 0.05, "one in twenty"
#: Level of every interval, and as a table shows it.
CONFIDENCE = 0.95
LEVEL = f"{100 * CONFIDENCE:g} %"

#: Standard errors up to which a published number agrees with ours, and up to which it is close.
AGREES_UP_TO, CLOSE_UP_TO = 2.0, 3.0
#: A p of all groups of a published table together below which the table differs from ours.
TABLE_DIFFERS_BELOW = 0.01

#: Means that differ by less than this, relatively, are as good as equal: the margin of equivalence.
EQUIVALENT_WITHIN = 0.01
#: Width of an interval from which on a rate of paths is too rough to be judged.
ROUGH_RATE = 0.05
#: Fewer paths than this that reach a size do not tell the error of its rate.
FEW_PATHS = 1_000
#: A difference of AIC beyond which the worse model has next to no support.
CLEAR_AIC = 10.0
#: A p below which a model of growth is refuted: by its lack of fit, or by sizes it has not seen. It
#: is divided by the number of trends that a run has judged.
REFUTED_BELOW = 0.01
#: Share of the triangles from which on the interior of a mesh counts as free of the edge.
FREE_OF_EDGE = 0.9
#: A change of the mean with each tenfold number of points that is no more than this is none.
LEVEL_PER_DECADE = 0.001
#: Growth like x^lambda with lambda above this shows no limit: a tenfold number of points leaves
#: more than three quarters of the way to it.
NEARLY_LOGARITHMIC = -0.1
