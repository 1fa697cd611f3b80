"""Points at which rounded arithmetic gives a wrong sign, by nearly as much as it can.

The filters of predicates and kernels trust a rounded value that is beyond a bound on its error.
Each fixture here was searched for, and is of one bound: with a quarter of that bound (with 0 for
what underflow loses) the filter would trust a sign that is wrong. Coordinates are hexadecimal, so
that their last bits stay as they are.
"""

import math

import numpy as np
from hypothesis import strategies as st


def read(pairs):
    """Points written in hexadecimal, as an array."""
    return np.array([[float.fromhex(x) for x in point] for point in pairs])


# a, b, c: rounding turns them the other way, by 1.6 EPSILON of the sum of the two products.
ALMOST_COLLINEAR = (
    (
        ("0x1.d34c2967f5932p-2", "0x1.98725d6fb92d4p-4"),
        ("0x1.1246a29514faap-1", "0x1.744bcc6e47454p-3"),
        ("-0x1.b908ac890dd68p-5", "-0x1.b633c285b50a8p-2"),
    ),
    (
        ("0x1.f28833cdaa376p-1", "-0x1.514a90243e734p-4"),
        ("0x1.1f6da08f6af60p+0", "-0x1.ac24c467edbb8p-3"),
        ("-0x1.54a27a5c09a64p-3", "0x1.c5f74f42a08b6p-1"),
    ),
)
# The same, where the two products round to different multiples of the least double.
ALMOST_COLLINEAR_AND_TINY = (
    (
        ("0x1.18ba17f129703p-538", "0x1.8bf3ab6bef586p-540"),
        ("0x1.291fe29fb1d02p-539", "-0x1.af09e42ac475bp-544"),
        ("-0x1.ad2e46b4dc221p-537", "-0x1.961a824a432b6p-537"),
    ),
    (
        ("0x1.1671079f10353p-538", "0x1.142a3db2ac794p-537"),
        ("0x1.5ac177645a7fcp-537", "0x1.4b044f6a15ab2p-536"),
        ("-0x1.51256294833f4p-538", "-0x1.281d45d3b4d3cp-537"),
    ),
)
# a, b, c, p: rounding puts p on the wrong side of the circle, by 0.90 and 0.72 EPSILON of the
# square of the sum of the squared distances.
ALMOST_COCIRCULAR = (
    (
        ("-0x1.d3944971c319cp-2", "0x1.2db4fd5b4257ep-3"),
        ("-0x1.c603fd54619dbp-5", "-0x1.1d76720466d87p-2"),
        ("0x1.4197708cd471bp-4", "-0x1.86c35cf256952p-4"),
        ("-0x1.de5000a1bc144p-2", "-0x1.6f2e75a49c1fep-3"),
    ),
    (
        ("-0x1.d3a8da5dae66cp-2", "0x1.2e11770b38a5ap-3"),
        ("-0x1.c603f461d4875p-5", "-0x1.1d7d60a5a2690p-2"),
        ("0x1.41e4c373dea74p-4", "-0x1.87e55cf64f2e6p-4"),
        ("-0x1.de5000a1bc136p-2", "-0x1.6f2e75a49c1fbp-3"),
    ),
)
# The same near a line, by 5.1 EPSILON of the permanent.
ALMOST_COCIRCULAR_AND_FLAT = (
    (
        ("-0x1.c6593cff8952bp-3", "0x1.2836923160c31p-9"),
        ("0x1.a6b9e1017f31bp-3", "0x1.a58425e989a98p-12"),
        ("-0x1.cb98202adae8cp-2", "0x1.7e04b7b965915p-8"),
        ("0x1.0ea7d8f81ea66p-3", "0x1.185d817ef2decp-12"),
    ),
)
# The same, where the fourth powers of distances underflow.
ALMOST_COCIRCULAR_AND_TINY = (
    (
        ("0x1.314e3165f00a0p-263", "0x1.4ad154e715e5dp-263"),
        ("-0x1.f34ffff94806ep-265", "0x1.842d4d7c6ae63p-263"),
        ("0x1.259f349866e64p-265", "0x1.e0d2017cb6cfdp-263"),
        ("-0x1.2d87bb347359ap-264", "0x1.8cb44eeb8771cp-265"),
    ),
    (
        ("-0x1.a3e32b9e9157bp-266", "-0x1.d1a66dd6d58c3p-265"),
        ("-0x1.3850901110ccap-265", "-0x1.992b2bc338016p-265"),
        ("-0x1.dd55d495c5713p-266", "-0x1.c7b589c16ecf4p-265"),
        ("0x1.69f44df39954ap-267", "-0x1.b53124c7e5fa1p-267"),
    ),
)
# The same, where a large square multiplies what the product of two small distances has lost.
TINY_BESIDE_LARGE = (
    (
        ("0x1.0000000000000p+200", "0x1.0000000000000p+200"),
        ("0x1.18ba17f129703p-538", "0x1.8bf3ab6bef586p-540"),
        ("0x1.291fe29fb1d02p-539", "-0x1.af09e42ac475bp-544"),
        ("-0x1.ad2e46b4dc221p-537", "-0x1.961a824a432b6p-537"),
    ),
    (
        ("0x0.0p+0", "0x1.0000000000000p+200"),
        ("0x1.18ba17f129703p-538", "0x1.8bf3ab6bef586p-540"),
        ("0x1.291fe29fb1d02p-539", "-0x1.af09e42ac475bp-544"),
        ("-0x1.ad2e46b4dc221p-537", "-0x1.961a824a432b6p-537"),
    ),
)

# Point sets, in order of insertion, that the filter of one comparison would triangulate wrongly.
PLAIN = {
    "parts of a triangle, 1": (
        ("-0x1.21ce6634f41eap-2", "0x1.b702dc15b5f78p-1"),
        ("-0x1.cf77235375f76p-4", "0x1.dbe0b210e519ap-2"),
        ("0x1.f8db672e84d76p-4", "-0x1.08f7c250c4084p+0"),
        ("-0x1.32d7f3724cc88p-4", "0x1.46b2c674985d4p-3"),
        ("0x1.d0e136014f9c0p-4", "-0x1.f3d021ed255fap-1"),
    ),
    "parts of a triangle, 2": (
        ("0x1.111243f4d0f52p+0", "-0x1.c72b19fb52070p-3"),
        ("-0x1.d5948ccb9c360p-4", "-0x1.471269449bf88p-4"),
        ("-0x1.ddaad48bc77c5p-2", "-0x1.51c2d61160462p-3"),
        ("-0x1.51385a5ce9a28p-4", "-0x1.263472f145840p-3"),
        ("0x1.ea254d5ca04dap-1", "-0x1.b7d8d6b998adap-3"),
    ),
    "parts of a tiny triangle, 1": (
        ("-0x1.d8c353b480190p-539", "0x1.b357d8ae54aeep-535"),
        ("0x1.6386a970ed064p-537", "-0x1.dd9ff38e31e23p-537"),
        ("-0x1.43f772031fe42p-536", "-0x1.abc43db272708p-537"),
        ("-0x1.bdd9bc91c4f5ap-538", "0x1.ab58ea228f06dp-537"),
        ("0x1.ef945e12844f5p-538", "-0x1.3513011618377p-537"),
    ),
    "parts of a tiny triangle, 2": (
        ("0x1.f4744803b4d98p-537", "0x1.26943de562dc0p-542"),
        ("-0x1.0f09456d1be94p-538", "-0x1.82233c44b932cp-536"),
        ("-0x1.999af8abde039p-537", "0x1.b39637df3aa51p-536"),
        ("0x1.904fa23f39240p-538", "-0x1.265d9e1675b34p-537"),
        ("-0x1.4aa750a73135cp-538", "0x1.943e1951fc926p-537"),
    ),
    "first new edge of the hull, 1": (
        ("0x1.37b99465bac06p-2", "-0x1.db16083ec55d0p-2"),
        ("-0x1.51d7e5a39f3e2p-4", "0x1.0cf38b66cd8aep-1"),
        ("0x1.50da961fed0a4p-1", "0x1.9fbe091d4820fp-3"),
        ("0x1.ce71fa9ca41b0p-4", "-0x1.0af9dee83b928p-5"),
        ("-0x1.2a83230fdb8a4p-4", "0x1.fdd3a59b6cb82p-2"),
    ),
    "first new edge of the hull, 2": (
        ("-0x1.460bcfb9a0583p+0", "-0x1.8320333f02d74p-2"),
        ("0x1.7f26855df349bp-2", "-0x1.175fe8b0f2100p-1"),
        ("0x1.c1e3f7f6b07bep-1", "-0x1.c4d9f48819af2p-1"),
        ("0x1.6551c84ee704ap-3", "0x1.9aab8bc746b1cp-3"),
        ("0x1.193d0ab2a1a88p-2", "0x1.7a543e272cd54p-5"),
    ),
    "second new edge of the hull, 1": (
        ("-0x1.25d641c33213ap-2", "-0x1.9c904e96f721dp-2"),
        ("-0x1.0bd21be965d52p-3", "-0x1.923d2c5d512d8p-3"),
        ("-0x1.0d6e1f77b8362p-1", "-0x1.328fa3372715cp-1"),
        ("0x1.89e065c08760cp-4", "0x1.8d17471be957cp-1"),
        ("-0x1.d3d4e93773412p-2", "-0x1.c8482c77e3198p-2"),
    ),
    "second new edge of the hull, 2": (
        ("0x1.ce0086855825ap-1", "-0x1.0a82fa454a8b2p+0"),
        ("-0x1.0294c08b088c8p-2", "-0x1.ef746a9ebaacap-2"),
        ("0x1.15d14f15a9c9dp+2", "0x1.098da458b5b4ap+1"),
        ("0x1.ae32d3f83f5bcp-5", "0x1.ecbb2c48ffe5cp-1"),
        ("-0x1.d837d48f83123p-3", "-0x1.84e9852659da0p-2"),
    ),
    "roots beside an edge, 1": (
        ("0x1.48c77014a006cp-4", "0x1.531b6b9943fa2p-1"),
        ("0x1.e75d466b06866p-1", "0x1.77be6bf7cbb28p-1"),
        ("0x1.7b6e4d02fcc14p-5", "0x1.41d46c4362bc2p+1"),
        ("-0x1.cdbb4079769f4p-2", "0x1.b46995d610980p-9"),
        ("-0x1.778b4b2e4b3c5p-2", "0x1.b95716edd7f19p-4"),
    ),
    "roots beside an edge, 2": (
        ("-0x1.4a96b4d4ec86ep+0", "0x1.c1083175a8e31p+0"),
        ("-0x1.c0f2961c71374p+0", "0x1.b9a36cd5f36bfp+0"),
        ("-0x1.d6e276e7674bcp-4", "-0x1.25e05dfdf7065p+1"),
        ("-0x1.0782d7a6c3f5ep-1", "0x1.0c7d9d082c780p-6"),
        ("0x1.146a855096c26p-3", "0x1.564f6aed3165ap-1"),
        ("-0x1.abe6bda39c5fep-2", "0x1.d129564c93288p-4"),
    ),
    "tiny hull, 1": (
        ("0x1.68105dd17c025p-536", "-0x1.723abe2a89f4bp-537"),
        ("0x1.16bbe3765846dp-540", "0x1.2bc30690e2e2ap-537"),
        ("-0x1.3323d7b391d0bp-537", "0x1.6df3f43c7d86cp-537"),
        ("0x1.ac6e3210297a1p-537", "-0x1.76767090b1656p-537"),
        ("0x1.e1fd9f1244a6dp-541", "0x1.a778c4b0b197dp-541"),
    ),
    "tiny hull, 2": (
        ("-0x1.48138f28f204ap-537", "0x1.68d19829f681ap-538"),
        ("0x1.87a9a9d33ff77p-537", "0x1.7304e759e2d61p-537"),
        ("-0x1.665b83d5d750ep-536", "0x1.9d9689d815d40p-537"),
        ("-0x1.68fd393b0e527p-539", "0x1.0e987f2df213ep-537"),
        ("-0x1.d28d37b10d2c5p-537", "-0x1.19dfa3181d24cp-537"),
        ("-0x1.af36ba12aeb2ap-538", "-0x1.6bdcbec04ce75p-539"),
    ),
}
DELAUNAY = {
    "cavity, 1": (
        ("0x1.935e271f74b2dp+3", "-0x1.9ad76eae7414cp+3"),
        ("-0x1.4e6dc00c54872p-1", "-0x1.319a363d560b5p-6"),
        ("0x1.5590243808b63p-2", "-0x1.8001e1e137c1ep-5"),
        ("0x1.39d79cd28128dp-4", "0x1.6f96df83c0f9dp-2"),
        ("-0x1.e0e7e9d9ec7dbp-3", "-0x1.219de8d186563p-1"),
    ),
    "cavity, 2": (
        ("-0x1.bb98fce5e2238p-2", "-0x1.48ade25b31f06p+0"),
        ("-0x1.d12272cdb3d4cp-2", "0x1.2e24c8146986bp-3"),
        ("-0x1.c680c28de1b0ap-5", "-0x1.1d76720466d87p-2"),
        ("-0x1.de4e9ebd8b139p-2", "-0x1.6f33ae041f29bp-3"),
        ("0x1.3c1bacb6ead54p-4", "-0x1.87e55cf64f303p-4"),
    ),
    "tiny cavity, 1": (
        ("0x1.a6b4b04df269cp-1", "0x1.aa81af8d23cbdp+0"),
        ("0x1.68e5f5732f750p-270", "-0x1.2ed41076df726p-266"),
        ("0x1.756d25ddc95e8p-269", "-0x1.85a04b43adf6ep-268"),
        ("-0x1.a6f96d1667130p-267", "0x1.301984cb2e33dp-266"),
        ("-0x1.d4e3a0126f446p-265", "-0x1.4e4ad3599ed37p-266"),
    ),
    "tiny cavity, 2": (
        ("-0x1.d11c320afe2fap-2", "-0x1.fbfbd342c5551p-4"),
        ("0x1.6eb56de6d70c1p-4", "-0x1.289a9b45a44dap+1"),
        ("0x1.886d5290c9d66p-3", "-0x1.079477c1a269ap+0"),
        ("0x1.b8a07fed93342p-265", "-0x1.c5b6c2a86d5d2p-266"),
        ("0x1.85c0673c03292p-265", "-0x1.8c426747c7ae4p-265"),
        ("0x1.35814cbad19c9p-265", "-0x1.2b788d67eb920p-269"),
        ("0x1.b3376bf73c920p-266", "-0x1.f062cc70f9dd6p-265"),
    ),
}
# Two edges whose rounded lengths are in the wrong order; of the last two, the difference is that of
# `equal_within`, and every rounding but one is as large as it can be and goes the same way.
EDGES = {
    "longest": (
        "0x0.0p+0",
        (
            ("-0x1.191f256c1d1e4p-2", "0x1.9b1d8a784eb00p-5"),
            ("-0x1.9e17e1365ba5cp-1", "-0x1.f13a9545fca98p-1"),
            ("-0x1.9df4ef425004ep-1", "-0x1.f14cdb435654cp-1"),
        ),
    ),
    "shortest": (
        "0x1.0000000000000p-10",
        (
            ("0x1.63e62f0fdc0cep-1", "-0x1.e614961eb0d84p-1"),
            ("-0x1.e82e08b1fdc84p-2", "0x1.58cd0fb3bd7aep-1"),
            ("0x1.590bd346d1abcp+1", "-0x1.c3962e92b0a70p-1"),
        ),
    ),
    "shortest in space": (
        "0x0.0p+0",
        (
            ("-0x1.f592d959cae70p-3", "-0x1.c55b01e83545cp-2", "0x1.f4a412d0501e8p-1"),
            ("0x1.0de8ebc2f0200p-8", "0x1.e87005365c5dap-1", "-0x1.a95998de8d59ap-1"),
            ("-0x1.ccd972d1864c8p-2", "-0x1.5db2b6247d2d6p+1", "0x1.01c38495e2824p+0"),
        ),
    ),
    "longest of a tiny triangle": (
        "0x0.0p+0",
        (
            ("0x1.3d0e2be70e668p-537", "-0x1.92e4d74186ca0p-538"),
            ("0x1.ad23781654c22p-537", "0x1.738d3f9d3b7bcp-537"),
            ("0x1.0866fb1e6a459p-538", "0x1.606012dece188p-537"),
        ),
    ),
    "shortest of a tiny triangle": (
        "0x1.0000000000000p-10",
        (
            ("0x1.6dfb62fd939bcp-537", "-0x1.dd9bbe31c861cp-537"),
            ("0x1.e67ea5ea42bbep-537", "0x1.0c8bbbe4a35dep-537"),
            ("-0x1.448bf3f499f70p-540", "-0x1.16b1d937f24ffp-535"),
        ),
    ),
    "equal within so much": (
        "0x1.2a59c21e48ffep-22",
        (
            ("-0x1.6666666666667p-2", "-0x1.6666666666667p-2"),
            ("0x1.6dad88227febep-2", "0x1.6dad958670adep-2"),
            ("0x1.6dad71d493794p-2", "0x1.6dad917574774p-2"),
        ),
    ),
    "equal within a little less": (
        "0x1.3c6124c75dffep-24",
        (
            ("-0x1.6666666666667p-2", "-0x1.6666666666667p-2"),
            ("0x1.6dad833380598p-2", "0x1.6dad759b9b438p-2"),
            ("0x1.6dad8b1d3398ap-2", "0x1.6dad66b431092p-2"),
        ),
    ),
}

# Above and below the limits of the error-free product, and of products of two and four differences.
exponents = st.sampled_from(
    [0, -260, -265, -450, -485, -486, *range(-541, -519), -1060, 250, 256, 450, 510, 511, 512, 1000]
)
ulps = st.integers(-3, 3)
coordinate = st.floats(-1.0, 1.0, allow_subnormal=False)


def scaled(points, exponent):
    """The same points, times a power of two: unchanged in their bits unless they underflow."""
    return [(math.ldexp(x, exponent), math.ldexp(y, exponent)) for x, y in points]


@st.composite
def near_collinear(draw):
    """Three points on a line, one of them moved by a few last bits, of any scale."""
    ax, ay, cx, cy = (draw(coordinate) for _ in range(4))
    t = draw(st.floats(-1.5, 1.5))
    bx, by = cx + t * (ax - cx), cy + t * (ay - cy)
    b = bx + draw(ulps) * math.ulp(bx), by + draw(ulps) * math.ulp(by)
    triple = draw(st.permutations([(ax, ay), b, (cx, cy)]))
    return scaled(triple, draw(exponents))


LATTICE_CIRCLE = [
    (x, y) for x in range(-65, 66) for y in range(-65, 66) if x * x + y * y == 65 * 65
]


@st.composite
def near_cocircular(draw):
    """Four points of a circle, shifted, with last bits moved, of any scale."""
    lattice = draw(st.booleans())
    if lattice:
        points = draw(st.permutations(LATTICE_CIRCLE))[:4]
        points = [(x / 64, y / 64) for x, y in points]
    else:
        angles = [draw(st.floats(0.0, 6.3)) for _ in range(4)]
        points = [(math.cos(angle), math.sin(angle)) for angle in angles]
    dx, dy = draw(st.sampled_from([(0.0, 0.0), (0.5, 0.25), (0.1, 0.7), (-1.0, 0.3)]))
    points = [(x + dx, y + dy) for x, y in points]
    points = [(x + draw(ulps) * math.ulp(x), y + draw(ulps) * math.ulp(y)) for x, y in points]
    return scaled(points, draw(exponents))
