# SPDX-License-Identifier: Apache-2.0
"""Reads and writes PNG files of 8 bits a channel, as far as povray's pictures and ours need it."""
import struct
import zlib

MAGIC = b"\x89PNG\r\n\x1a\n"
CHANNELS = {0: 1, 2: 3, 4: 2, 6: 4}


def chunks(data):
    """Yields (kind, data) of each chunk. Raises ValueError for data that is no PNG file."""
    if not data.startswith(MAGIC):
        raise ValueError("no PNG file")
    at = len(MAGIC)
    while at < len(data):
        size, = struct.unpack(">I", data[at:at + 4])
        yield data[at + 4:at + 8], data[at + 8:at + 8 + size]
        at += 12 + size


def nearest(left, up, corner):
    """Returns the value that Paeth's predictor gives."""
    to_left, to_up, to_corner = abs(up - corner), abs(left - corner), abs(left + up - 2 * corner)
    if to_left <= to_up and to_left <= to_corner:
        return left
    return up if to_up <= to_corner else corner


def unfiltered(kind, row, above, step):
    """Adds to each byte, in place, the value that its neighbours predict. Returns the row."""
    for i in range(len(row) if kind else 0):
        left = row[i - step] if i >= step else 0
        if kind == 1:
            guess = left
        elif kind == 2:
            guess = above[i]
        elif kind == 3:
            guess = (left + above[i]) // 2
        else:
            guess = nearest(left, above[i], above[i - step] if i >= step else 0)
        row[i] = (row[i] + guess) & 255
    return row


def read_png(path):
    """Returns (width, height, width x height x 3 bytes), without alpha.

    Raises ValueError for a file that is no PNG, is interlaced, has a palette or other than 8 bits
    a channel.
    """
    packed = b""
    for kind, data in chunks(path.read_bytes()):
        if kind == b"IHDR":
            width, height, depth, color, _, _, interlaced = struct.unpack(">IIBBBBB", data)
            if depth != 8 or color not in CHANNELS or interlaced:
                raise ValueError(f"{path}: found a PNG of another form, expected 8 bits a channel, "
                                 "not interlaced")
        elif kind == b"IDAT":
            packed += data
    step = CHANNELS[color]
    raw, above, pixels = zlib.decompress(packed), bytearray(width * step), bytearray()
    for at in range(0, len(raw), 1 + width * step):
        above = unfiltered(raw[at], bytearray(raw[at + 1:at + 1 + width * step]), above, step)
        if step == 3:
            pixels += above
            continue
        row = bytearray(3 * width)
        for channel in range(3):
            row[channel::3] = above[min(channel, step - 1) if step > 2 else 0::step]
        pixels += row
    return width, height, bytes(pixels)


def write_png(path, width, height, pixels):
    """Writes a picture of 8 bits a channel. pixels: width x height x 3 bytes."""
    def chunk(kind, data):
        size, checksum = struct.pack(">I", len(data)), struct.pack(">I", zlib.crc32(kind + data))
        return size + kind + data + checksum
    rows = b"".join(b"\0" + pixels[at:at + 3 * width] for at in range(0, len(pixels), 3 * width))
    path.write_bytes(MAGIC + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
                     chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
