"""Damage of the kinds that files suffer: by disks, tools, editors and ill will.

Every mutation takes a random generator and the bytes of a file and returns other bytes; the same
generator state gives the same damage.
"""

import random
import re
import struct
import zlib
from collections.abc import Callable
from itertools import pairwise

Mutation = Callable[[random.Random, bytes], bytes]
NUMBERS = (
    "0", "-1", "1", "1e308", "-1e308", "1e-308", "nan", "inf", "-inf", "9" * 30,
    "9" * 400, "9" * 5000, "0x" + "f" * 5000,
    "9223372036854775807", "-9223372036854775809", "0.0", "1_000", "0x7fffffff", '"text"', '""',
    "[]", "[1, 2, 3]", "[[0]]", "{}", "true", "1979-05-27", "1e5", "3.5", "''", "2000000000",
)  # fmt: skip
ENCODINGS = ("utf-16", "utf-16-be", "utf-32", "utf-8-sig", "cp037")
_NUMBER = re.compile(rb"-?\d+(\.\d+)?(e-?\d+)?", re.IGNORECASE)
_KEY = re.compile(rb"[A-Za-z_][A-Za-z_0-9]{2,}")
_PNG_HEADER = 8


def flipped(rng: random.Random, data: bytes) -> bytes:
    """One to eight bytes changed."""
    out = bytearray(data)
    for _ in range(rng.randint(1, 8)):
        if out:
            out[rng.randrange(len(out))] = rng.randrange(256)
    return bytes(out)


def truncated(rng: random.Random, data: bytes) -> bytes:
    """Cut off somewhere, perhaps to nothing."""
    return data[: rng.randrange(len(data) + 1)]


def zeroed(rng: random.Random, data: bytes) -> bytes:
    """A block of zeros, as after a crash of a file system."""
    begin = rng.randrange(len(data) + 1)
    count = min(rng.randint(1, 512), len(data) - begin)
    return data[:begin] + bytes(count) + data[begin + count :]


def repeated(rng: random.Random, data: bytes) -> bytes:
    """A piece of the file twice."""
    begin, end = sorted(rng.randrange(len(data) + 1) for _ in range(2))
    return data[:end] + data[begin:end] + data[end:]


def without_piece(rng: random.Random, data: bytes) -> bytes:
    """A piece of the file missing."""
    begin = rng.randrange(len(data) + 1)
    return data[:begin] + data[begin + rng.randint(1, 64) :]


def with_noise(rng: random.Random, data: bytes) -> bytes:
    """Random bytes put in."""
    begin = rng.randrange(len(data) + 1)
    return data[:begin] + rng.randbytes(rng.randint(1, 64)) + data[begin:]


def other_number(rng: random.Random, data: bytes) -> bytes:
    """One to three numbers, or what looks like one, of another value or type."""
    for _ in range(rng.randint(1, 3)):
        data = _replaced(rng, data, _NUMBER, rng.choice(NUMBERS).encode())
    return data


def renamed_key(rng: random.Random, data: bytes) -> bytes:
    """A word spelt wrong, or another word of the file in its place."""
    words = _KEY.findall(data)
    if not words:
        return data
    word = rng.choice(words)
    wrong = (word[:-1], word.upper(), word + b"_", rng.choice(words), b"names", "größe".encode())
    return _replaced(rng, data, _KEY, rng.choice(wrong))


def _replaced(rng: random.Random, data: bytes, what: re.Pattern, by: bytes) -> bytes:
    hits = list(what.finditer(data))
    if not hits:
        return data
    hit = rng.choice(hits)
    return data[: hit.start()] + by + data[hit.end() :]


def other_lines(rng: random.Random, data: bytes) -> bytes:
    """A line missing, twice or elsewhere."""
    lines = data.splitlines(keepends=True)
    if not lines:
        return data
    line = lines.pop(rng.randrange(len(lines)))
    for _ in range(rng.choice((0, 1, 2))):
        lines.insert(rng.randint(0, len(lines)), line)
    return b"".join(lines)


def other_encoding(rng: random.Random, data: bytes) -> bytes:
    """The text as another program would save it."""
    return data.decode("utf-8", "replace").encode(rng.choice(ENCODINGS), "replace")


def deep(rng: random.Random, data: bytes) -> bytes:
    """A value in very many brackets, tables or elements."""
    depth = rng.choice((10, 100, 1000, 5000, 20_000))
    nested = rng.choice((
        b"deep = " + b"[" * depth + b"1" + b"]" * depth,
        b"deep = " + b"{ a = " * depth + b"1" + b"}" * depth,
        b"[" + b".".join([b"a"] * depth) + b"]",
        b"a." * depth + b"b = 1",
        b"<a>" * depth + b"</a>" * depth,
        b"K_deep: " + b"[" * depth + b"]" * depth,
    ))  # fmt: skip
    return _in_line(rng, data, nested)


def long(rng: random.Random, data: bytes) -> bytes:
    """A line of very many letters, digits or values."""
    count = rng.choice((1000, 100_000, 1_000_000))
    line = rng.choice((
        b'name = "' + b"n" * count + b'"',
        b"fps = " + b"1" * count,
        b"frames = [" + b"0, " * count + b"1]",
        b"#" * count,
        b" " * count,
    ))  # fmt: skip
    return _in_line(rng, data, line)


def _in_line(rng: random.Random, data: bytes, line: bytes) -> bytes:
    lines = data.splitlines()
    lines.insert(rng.randint(0, len(lines)), line)
    return b"\n".join(lines)


def entities(rng: random.Random, data: bytes) -> bytes:
    """XML entities that stand for a billion letters."""
    names = "abcdefghij"
    rows = ["<!ENTITY a 'lol'>"]
    rows += [f"<!ENTITY {n} '{f'&{b};' * 10}'>" for b, n in pairwise(names)]
    kind = f"<!DOCTYPE calibration [{''.join(rows)}]>".encode()
    begin = max(data.find(b"<calibration"), 0)
    bomb = rng.choice((b"&j;", b"&e;"))
    return data[:begin] + kind + data[begin:].replace(b"</camera>", bomb + b"</camera>", 1)


def other_png_header(rng: random.Random, data: bytes) -> bytes:
    """Another size or kind of pixels in a PNG's header, with a checksum that is right."""
    if data[12:16] != b"IHDR":
        return data
    sizes = (0, 1, 2**15, 2**16, 10**6, 2**20 - 1, 2**31 - 1, 2**32 - 1)
    width, height = (rng.choice((*sizes, 80, 60)) for _ in range(2))
    rest = data[24:29]
    if rng.random() < 0.3:
        rest = bytes((rng.choice((1, 2, 8, 16, 0)), rng.choice((0, 2, 3, 4, 6)), *rest[2:]))
    header = b"IHDR" + struct.pack(">II", width, height) + rest
    return data[:12] + header + struct.pack(">I", zlib.crc32(header)) + data[33:]


def other_counts(rng: random.Random, data: bytes) -> bytes:
    """A two- or four-byte number somewhere near the beginning replaced by an extreme one."""
    width = rng.choice((2, 4))
    begin = rng.randrange(max(1, min(len(data), 600) - width))
    extreme = rng.choice((b"\0" * 4, b"\xff" * 4, b"\x7f\xff\xff\xff", b"\xff\xff\xff\x7f"))
    return data[:begin] + extreme[:width] + data[begin + width :]


BYTES: tuple[Mutation, ...] = (flipped, truncated, zeroed, repeated, without_piece, with_noise)
TEXT: tuple[Mutation, ...] = (
    *BYTES, other_number, other_number, other_number, renamed_key, renamed_key, other_lines,
    other_lines, other_encoding, deep, long,
)  # fmt: skip
XML: tuple[Mutation, ...] = (*TEXT, entities)
PICTURE: tuple[Mutation, ...] = (*BYTES, other_counts, other_counts)
PNG: tuple[Mutation, ...] = (*PICTURE, other_png_header, other_png_header)
