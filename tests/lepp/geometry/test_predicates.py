import naive
from hypothesis import given, settings
from hypothesis import strategies as st

from lepp.geometry.predicates import exact_orientation, orientation

anything = st.floats(allow_nan=False, allow_infinity=False)
near_one = st.integers(-4, 4).map(lambda k: 1.0 + k * 2.0**-52)
lattice = st.integers(-5, 5).map(float)
tiny = st.integers(-3, 3).map(lambda k: k * 5e-324)
six = st.one_of(
    *(
        st.tuples(*[s] * 6)
        for s in (anything, near_one, lattice, tiny, anything | near_one | lattice)
    )
)


@settings(max_examples=600, deadline=None)
@given(six)
def test_orientation_is_exact_for_all_doubles(numbers):
    a, b, c = naive.exact([numbers[:2], numbers[2:4], numbers[4:]])
    area = naive.turn(a, b, c)
    sign = (area > 0) - (area < 0)
    assert orientation(*numbers) == sign
    assert exact_orientation(*numbers) == sign
