import tracemalloc
import warnings

import numpy as np
import pytest

from antnav import maps
from antnav.errors import MapError, MapFormatError, MapSizeError
from antnav.world.grid import GridMap

from . import samples


@pytest.fixture
def load(tmp_path):
    def run(data):
        path = tmp_path / "a.npy"
        path.write_bytes(data)
        return maps.load_map(path)

    return run


@pytest.mark.parametrize("dtype", [np.uint8, np.int8, np.int64, ">i4", np.uint16])
@pytest.mark.parametrize("order", ["C", "F"])
def test_integers(load, dtype, order):
    assert np.array_equal(load(samples.npy(np.array(samples.CELLS, dtype=dtype, order=order))).cells, samples.CELLS)


def test_booleans_mean_occupied(load):
    assert load(samples.npy(np.array([[True, False]]))).cells.tolist() == [[1, 0]]


def test_header_of_version_2(load):
    header = samples.npy_header("{'descr': '|u1', 'fortran_order': False, 'shape': (1, 2)}\n", version=2)
    assert load(header + b"\0\1").cells.tolist() == [[0, 1]]


@pytest.mark.parametrize(
    "array",
    [
        np.zeros((2, 2)),
        np.zeros((2, 2), dtype=complex),
        np.zeros(4, dtype=np.uint8),
        np.zeros((1, 2, 2), dtype=np.uint8),
        np.zeros((), dtype=np.uint8),
        np.zeros((2, 2), dtype="U3"),
        np.zeros((2, 2), dtype=[("a", "u1")]),
        np.zeros((2, 2), dtype="M8[s]"),
        np.array([[object()]]),
        np.array([[0, 4]]),
        np.array([[-1, 100]], dtype=np.int8),
    ],
    ids=lambda array: f"{array.dtype} {array.shape}",
)
def test_other_arrays(load, array):
    with pytest.raises(MapFormatError, match=r"a\.npy: cells of"):
        load(samples.npy(array) if array.dtype != object else samples.npy_header(OBJECTS) + b"\x80\x04N.")


@pytest.mark.parametrize(
    "array, remedy",
    [
        (np.array([[0.0, 1.0]]), "astype.*if 0 is free"),
        (np.zeros((2, 2)), "astype.*if 0 is free"),
        (np.array([[0.0, 0.5]]), "probabilities"),
        (np.array([[0.0, 100.0]]), "to_cells"),
        (np.array([[-1, 100]]), "to_cells.*astype.*values='occupancy'"),
        (np.array([[0, 254]], np.uint8), "gray image save it as a PNG.*costs"),
        (np.array([[0.0, 254.0]]), "gray image save it as a PNG.*costs"),
        (np.array([[0, 1000]]), "say which"),
        (np.array([[np.nan, 0]]), "say which"),
        (np.zeros((4, 4, 3), np.uint8), "PNG"),
        (np.zeros((4, 4, 9), np.uint8), r"\(rows, cols\)"),
        (np.array([["0", "1"]]), "astype.*0 is free"),
    ],
)
def test_no_remedy_inverts_or_closes_a_map(load, array, remedy):
    with pytest.raises(MapFormatError, match=remedy) as caught:
        load(samples.npy(array))
    assert ">= 100" not in caught.value.remedy
    assert "> 0.5" not in caught.value.remedy
    with pytest.raises(MapError, match=remedy):
        GridMap(array)


def test_occupancy_values(tmp_path):
    np.save(tmp_path / "a.npy", np.array([[-1, 0, 100]]))
    assert maps.load_map(tmp_path / "a.npy", values="occupancy").cells.tolist() == [[2, 0, 1]]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        np.save(tmp_path / "b.npy", np.array([[0, 100]], dtype=">i2"))
        assert maps.load_map(tmp_path / "b.npy", values="occupancy").cells.tolist() == [[0, 1]]


@pytest.mark.parametrize("array", [[[0, 101]], [[-2, 0]], [[0.0, 100.0]], [[True, False]]])
def test_what_is_no_occupancy(tmp_path, array):
    np.save(tmp_path / "a.npy", array)
    with pytest.raises(MapFormatError, match="OccupancyGrid values are whole numbers"):
        maps.load_map(tmp_path / "a.npy", values="occupancy")


OBJECTS = "{'descr': '|O', 'fortran_order': False, 'shape': (1, 1)}\n"


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\x93NUMPY",
        b"\x93NUMPY\x01\x00",
        b"\x93NUMPY\x07\x00\x10\x00",
        samples.npy(samples.CELLS)[:-1],
        samples.npy_header("{'descr': '|u1', 'fortran_order': False, 'shape': (-1, 2)}"),
        samples.npy_header("{'descr': '|u1', 'fortran_order': False}"),
        samples.npy_header("{'descr': 'what', 'fortran_order': False, 'shape': (1, 2)}"),
        samples.npy_header("{'descr': '|u1', 'fortran_order': False, 'shape': (1L, 2L)}") + b"\0",
        samples.npy_header("{'descr': '|u1', 'fortran_order': False, 'shape': (True, True)}") + b"\0",
        samples.npy_header("(" * 5000),
        samples.npy_header("{'\\d': '|u1'}"),
        samples.npy_header("x" * 20_000),
        samples.npy(samples.CELLS).replace(b"\x93NUMPY", b"\x94NUMPY"),
    ],
)
def test_damaged_files(load, data):
    with warnings.catch_warnings(), pytest.raises((MapFormatError, MapSizeError)):
        warnings.simplefilter("error")
        load(data)


@pytest.mark.parametrize("shape", [(31_623, 31_623), (10**9, 1), (1, 10**30), (0, 3), (3, 0)])
def test_sizes_are_refused_before_anything_is_allocated(load, shape):
    header = samples.npy_header(f"{{'descr': '<i8', 'fortran_order': False, 'shape': {shape}}}\n")
    tracemalloc.start()
    try:
        with pytest.raises(MapSizeError):
            load(header + bytes(16))
        assert tracemalloc.get_traced_memory()[1] < 10**6
    finally:
        tracemalloc.stop()


def test_round_trip(tmp_path):
    maps.save_map(GridMap([[0, 1, 2, 3]]), tmp_path / "a.npy")
    assert maps.load_map(tmp_path / "a.npy") == GridMap([[0, 1, 2, 1]])
