import numpy as np
import pytest
from PIL import Image

from antnav.errors import MapFileError, MapFormatError, MapSizeError
from antnav.maps.image import read_image

from . import samples

A = np.array([[0, 100, 205], [254, 255, 1]], dtype=np.uint8)
COLOUR = np.dstack([A, A, A // 2])


@pytest.fixture
def decode(tmp_path):
    def run(data):
        path = tmp_path / "image"
        path.write_bytes(data)
        return read_image(path)

    return run


@pytest.mark.parametrize(
    "data",
    [
        b"P5\n3 2\n255\n" + A.tobytes(),
        b"P5\n# by hand\n3\n# rows next\n2\n255\n" + A.tobytes(),
        b"P5 3 2 # sizes\n255\n" + A.tobytes(),
        b"P2\n# a\n3 2 255\n0 100 205 # b\n254 255 1\n",
        b"P5\n3 2\n65535\n" + (A.astype(">u2") * 257).tobytes(),
        samples.encode(A, "PNG"),
        samples.encode(A.astype(np.uint16) * 257, "PNG"),
        samples.encode(np.dstack([A, A, A]), "PNG"),
        samples.encode(A, "BMP"),
        samples.encode(np.dstack([A, A, A]), "BMP"),
    ],
    ids=["P5", "comments", "comment in line", "P2", "16 bit PGM", "PNG", "16 bit PNG", "RGB PNG", "BMP", "RGB BMP"],
)
def test_gray_pixels(decode, data):
    picture = decode(data)
    assert picture.pixels.dtype == np.uint8
    assert np.array_equal(picture.pixels, A)
    assert picture.alpha is None


def test_the_largest_value_of_a_pgm_is_white(decode):
    assert decode(b"P5\n3 1\n15\n" + bytes((0, 7, 15))).pixels.tolist() == [[0, 119, 255]]
    assert decode(b"P2\n3 1\n1000\n0 500 1000").pixels.tolist() == [[0, 127, 255]]


@pytest.mark.parametrize("file_format", ["PNG", "TIFF"])
def test_16_bits_become_8_as_in_graphicsmagick(decode, file_format):
    deep = np.array([[0, 128, 256, 257, 52684, 52685, 65535]], dtype=np.uint16)  # 52685 = 205 * 257
    assert decode(samples.encode(deep, file_format)).pixels.tolist() == [[0, 0, 0, 1, 204, 205, 255]]


def test_floats_of_a_tiff(decode):
    shades = np.array([[0, 0.25, 0.5, 0.8, 0.804, 1, 1.5, -1, np.nan]], dtype=np.float32)
    expected = [[0, 63, 127, 204, 205, 255, 255, 0, 0]]  # GraphicsMagick's, but for nan
    assert decode(samples.encode(shades, "TIFF")).pixels.tolist() == expected


def test_pixels_of_32_bits(decode):
    with pytest.raises(MapFormatError, match="more than 16 bits"):
        decode(samples.encode(np.array([[0, 70_000]], dtype=np.int32), "TIFF"))


@pytest.mark.parametrize("file_format", ["TIFF", "WEBP", "GIF", "JPEG"])
def test_other_formats_that_map_server_reads(decode, file_format):
    large = A.repeat(16, axis=0).repeat(16, axis=1)
    options = {"lossless": True} if file_format == "WEBP" else {}
    picture = decode(samples.encode(large, file_format, **options))
    assert np.abs(picture.pixels.astype(int) - large).max() <= (3 if file_format == "JPEG" else 0)
    assert picture.blurred == (file_format in ("JPEG", "WEBP"))


def test_the_first_page_counts(tmp_path):
    first, second = Image.fromarray(A), Image.fromarray(255 - A)
    for name in ("a.gif", "a.tif"):
        first.save(tmp_path / name, save_all=True, append_images=[second])
        assert np.array_equal(read_image(tmp_path / name).pixels, A)


def test_single_bits_and_bitmaps(decode):
    assert np.array_equal(decode(samples.encode(A > 100, "PNG")).pixels, np.where(A > 100, 255, 0))
    assert decode(b"P1\n3 1\n0 1 0").pixels.tolist() == [[255, 0, 255]]  # in PBM, 1 is black


def test_colour_stays_colour(decode):
    assert np.array_equal(decode(samples.encode(COLOUR, "PNG")).pixels, COLOUR)
    assert np.array_equal(decode(samples.encode(COLOUR, "BMP")).pixels, COLOUR)


def test_palettes_become_their_colours(decode, tmp_path):
    picture = Image.fromarray(np.array([[0, 1, 2]], dtype=np.uint8), mode=None).convert("P")
    picture.putpalette([254, 254, 254, 0, 0, 0, 205, 205, 205])
    picture.save(tmp_path / "p.png")
    assert read_image(tmp_path / "p.png").pixels.tolist() == [[254, 0, 205]]
    picture.save(tmp_path / "t.png", transparency=2)
    assert read_image(tmp_path / "t.png").alpha.tolist() == [[255, 255, 0]]


def test_alpha_is_read_apart(decode):
    alpha = np.array([[255, 0, 7], [255, 255, 254]], dtype=np.uint8)
    for channels in ([A, alpha], [A, A, A, alpha]):
        picture = decode(samples.encode(np.dstack(channels), "PNG"))
        assert np.array_equal(picture.pixels, A)
        assert np.array_equal(picture.alpha, alpha)


@pytest.mark.parametrize("bits", [8, 16])
def test_a_transparent_gray_level_is_alpha(decode, bits):
    factor = 1 if bits == 8 else 257
    pixels = A.astype(np.uint8 if bits == 8 else np.uint16) * factor
    picture = decode(samples.encode(pixels, "PNG", transparency=205 * factor))
    assert np.array_equal(picture.pixels, A)
    assert np.array_equal(picture.alpha, np.where(A == 205, 0, 255))


@pytest.mark.parametrize("sample", [samples.PGM, samples.PLAIN_PGM, samples.encode(A, "PNG"), samples.encode(A, "BMP")])
@pytest.mark.parametrize("kept", [0, 1, 5, 12, 0.3, 0.6])
def test_truncated_files(decode, sample, kept):
    length = kept if isinstance(kept, int) else int(len(sample) * kept)
    with pytest.raises(MapFormatError, match="save it again"):
        decode(sample[:length])


@pytest.mark.parametrize(
    "data",
    [
        b"P5\n3 2\n255\n" + A.tobytes()[:-1],
        b"P2\n3 2\n255\n0 1 2 3 4",
        b"P2\n3 1\n255\n0 300 2",
        b"P5\n-3 2\n255\n" + A.tobytes(),
        b"P5\n0 2\n255\n" + A.tobytes(),
        b"P5\nthree 2\n255\n" + A.tobytes(),
        b"Pf\n1 1\n-1.0\n\0\0\0\0",
        samples.encode(COLOUR, "JPEG2000"),
        samples.encode(COLOUR, "JPEG")[:300],
        b"P5\n9000 9000\n255\n",
        b"",
    ],
)
def test_damaged_and_foreign_files(decode, data):
    with pytest.raises(MapFormatError, match="PGM, PNG, BMP, TIFF, WebP, GIF or JPEG"):
        decode(data)


@pytest.mark.parametrize("cols, rows", [(40_000, 40_000), (12_000, 12_000), (2**27 + 1, 1)])
def test_too_large_a_header(decode, cols, rows):
    for data in (
        b"P5\n%d %d\n255\n" % (cols, rows),
        samples.png_claiming(cols, rows),
        samples.bmp_claiming(cols, rows),
    ):
        with pytest.raises(MapSizeError, match=str(2**27)) as caught:
            decode(data)
        assert "178956970" not in str(caught.value)  # Pillow's own limit


def test_missing_files_and_folders(tmp_path):
    for path in (tmp_path, tmp_path / "none.pgm", tmp_path / "a\0b"):
        with pytest.raises(MapFileError):
            read_image(path)


@pytest.mark.parametrize("suffix", [".pgm", ".PPM", ".pbm"])
def test_wrong_first_bytes_are_shown(tmp_path, suffix):
    path = tmp_path / f"a{suffix}"
    path.write_bytes(b"# made by hand\nP2\n1 1\n255\n0\n")
    with pytest.raises(MapFormatError, match="first two bytes are '# ', not P1 to P6"):
        read_image(path)
