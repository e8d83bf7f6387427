#!/usr/bin/env python3
"""Decodes streams by what docs/stream.md says, and by nothing else: a reader that shares no line with the library.

Usage: read_stream.py FILE...: fails unless each is whole and every count comes out. A wrong step would put the range
coder out of step, and the counts and the end of the block with it.
"""
import math
import struct
import sys
import zlib


class Coder:
    def __init__(self, block):
        self.block, self.at, self.range, self.code = block, 0, 2**32 - 1, 0
        for _ in range(4):
            self.code = self.code << 8 | self.byte()

    def byte(self):
        self.at += 1
        return self.block[self.at - 1] if self.at <= len(self.block) else 0

    def renew(self):
        while self.range < 2**24:
            self.range <<= 8
            self.code = self.code << 8 | self.byte()

    def bit(self, model):
        share = (self.range >> 16) * model[0]
        one = self.code < share
        self.code -= 0 if one else share
        self.range = share if one else self.range - share
        self.renew()
        step = ((65504 if one else 32) - model[0]) * (131072 // (2 * model[1] + 5))
        model[0] += step // 65536 if step >= 0 else -(-step // 65536)
        model[1] = min(120, model[1] + 1)
        return int(one)

    def part(self, whole):
        return min(self.code // (self.range // whole), whole - 1)

    def take(self, whole, first, width):
        share = self.range // whole
        self.code -= first * share
        self.range = width * share
        self.renew()

    def number(self, below):
        digits = 1
        while below - 1 >> 16 * digits:
            digits += 1
        value, at_top = 0, True
        for shift in range(16 * (digits - 1), -1, -16):
            most = below - 1 >> shift & 65535
            whole = most + 1 if at_top else 65536
            digit = self.part(whole)
            self.take(whole, digit, 1)
            at_top = at_top and digit == most
            value = value << 16 | digit
        return value

    def is_spent(self):
        return 0 <= self.at - len(self.block) <= 4


def models(percent, *sizes):
    if not sizes:
        return [65536 * percent // 100, 0]
    return [models(percent, *sizes[1:]) for _ in range(sizes[0])]


class Models:
    def __init__(self):
        self.count = models(15, 3, 12)
        self.row, self.column = models(50, 8), models(50, 8)
        self.ready = models(70, 2, 3, 4)
        self.inside = models(40, 2, 4, 8)
        self.length, self.behind, self.sign = models(70, 2, 32), models(50, 2, 32, 3), models(50, 4)

    def hurry(self):
        for one in self.length + [tail for kind in self.behind for tail in kind]:
            for model in one:
                model[1] = min(model[1], 4)


def area2(p, q, r):
    return (q[0] - p[0]) * (r[1] - p[1]) - (r[0] - p[0]) * (q[1] - p[1])


def post_class(posts):
    if posts <= 8:
        return (0, 0, 1, 2, 3, 3, 4, 4, 4)[posts]
    return min(11, 5 + max(0, (posts - 1).bit_length() - 4))


LIMITS = (-4, -1.5, -0.6, -0.1, 0.5, 1.3, 3)


def angle_class(v, w, x, y):
    def less(p, q):
        return float(p[0] - q[0]), float(p[1] - q[1])

    def dot(p, q):
        return p[0] * q[0] + p[1] * q[1]

    def cross(p, q):
        return p[0] * q[1] - p[1] * q[0]

    a, cross_a = dot(less(x, v), less(y, v)), cross(less(x, v), less(y, v))
    b, cross_b = dot(less(x, w), less(y, w)), cross(less(y, w), less(x, w))
    return sum((a * cross_b + b * cross_a) / (cross_a * cross_b) > limit for limit in LIMITS)


def before(edge):
    return edge[0], (edge[1] + 2) % 3


def behind(edge):
    return edge[0], (edge[1] + 1) % 3


class Mesh:
    """Triangles as corners; beyond[t][i]: the edge on the other side of edge i, as (triangle, edge), or None."""

    def __init__(self, columns, rows):
        self.columns, self.rows = columns, rows
        self.models, self.step = Models(), 1

    def start(self, coder):
        self.step = 2 ** coder.number(31)
        layers, rising = coder.number(128), coder.number(2)
        heights = [(coder.number(2**31 // self.step + 1) - 2**30 // self.step) * self.step for _ in range(4)]
        places = (0, 0), (self.columns, 0), (0, self.rows), (self.columns, self.rows)
        self.vertices = [(*place, height) for place, height in zip(places, heights)]
        self.triangles = [[0, 1, 3], [3, 2, 0]] if rising else [[2, 0, 1], [1, 3, 2]]
        self.beyond = [[None, None, (1, 2)], [None, None, (0, 2)]]
        return layers

    def corner(self, edge):
        return self.triangles[edge[0]][edge[1]]

    def ends(self, t, i):
        return self.vertices[self.triangles[t][i]], self.vertices[self.triangles[t][(i + 1) % 3]]

    def belongs(self, t, post):
        zeros = 0
        for i in range(3):
            a, b = self.ends(t, i)
            left = area2(a, b, post)
            owned = b[1] > a[1] or (b[1] == a[1] and b[0] > a[0]) or self.beyond[t][i] is None
            if left < 0 or (left == 0 and not owned):
                return False
            zeros += left == 0
        return zeros < 2

    def place_on_scale(self, coder, tree, count):
        if count < 8:
            return coder.number(count)
        node = 1
        for _ in range(3):
            node = 2 * node + coder.bit(tree[node])
        start, end = (node - 8) * count // 8, (node - 7) * count // 8
        return start + coder.number(end - start)

    def places(self, coder, t):
        xs, ys = zip(*(self.vertices[v][:2] for v in self.triangles[t]))
        x, y, width, height = min(xs), min(ys), max(xs) - min(xs) + 1, max(ys) - min(ys) + 1
        posts = [(i, j) for j in range(y, y + height) for i in range(x, x + width) if self.belongs(t, (i, j))]
        count, most = 0, min(len(posts), 65535)
        while count < most and coder.bit(self.models.count[min(count, 2)][post_class(most)]):
            count += 1
        if width * height <= 256 and count == 1:
            return [posts[coder.number(len(posts))]]
        chosen = []
        if width * height <= 256:
            for left, post in zip(range(len(posts), 0, -1), posts):
                wanted = count - len(chosen)
                if wanted == 0:
                    break
                is_one = coder.part(left) < wanted
                coder.take(left, 0 if is_one else wanted, wanted if is_one else left - wanted)
                chosen += [post] if is_one else []
            return chosen
        for _ in range(count):
            j = y + self.place_on_scale(coder, self.models.row, height)
            row = [post for post in posts if post[1] == j]
            chosen.append(row[self.place_on_scale(coder, self.models.column, len(row))])
        return chosen

    def layer(self, coder):
        self.models.hurry()
        self.place, self.lies_in = [], []
        for t in range(len(self.triangles)):
            for post in self.places(coder, t):
                self.place.append(post)
                self.lies_in.append(t)
        self.waiting_in = {}
        for p, t in enumerate(self.lies_in):
            self.waiting_in.setdefault(t, []).append(p)
        waiting, first = list(range(len(self.place))), True
        while waiting:
            left = [p for p in waiting if not self.insert_if_ready(coder, p, first)]
            assert len(left) < len(waiting), 'vertices wait for each other'
            waiting = left if first else left[::-1]
            first = False

    def insert_if_ready(self, coder, p, first):
        t = self.lies_in[p]
        own = len(self.waiting_in[t]) - 1
        near = sum(min(3, len(self.waiting_in.get(edge[0], []))) for edge in self.beyond[t] if edge)
        if not coder.bit(self.models.ready[not first][min(own, 2)][min(near, 3)]):
            return False
        cavity, outer, is_open = self.cavity(coder, t, self.place[p])
        height = self.height(coder, t, self.place[p], int(is_open))
        moved = [q for c in cavity for q in self.waiting_in.pop(c, []) if q != p]
        self.vertices.append((*self.place[p], height))
        fan = self.fan(cavity, outer, is_open)
        for q in moved:
            self.lies_in[q] = next(s for s in fan if self.belongs(s, self.place[q]))
            self.waiting_in.setdefault(self.lies_in[q], []).append(q)
        return True

    def cavity(self, coder, t, at):
        under = next(((t, i) for i in range(3) if area2(*self.ends(t, i), at) == 0), None)
        other = self.beyond[t][under[1]] if under else None
        cavity, common, first = [t], set(self.triangles[t]), under or (t, 0)
        stack, outer = [], []
        if other:
            cavity.append(other[0])
            common = {self.corner(under), self.corner(other)}
            stack += [before(other), behind(other)]
        stack += [before(first), behind(first)] + ([] if under else [first])
        while stack:
            edge = stack.pop()
            other = self.beyond[edge[0]][edge[1]]
            if other and len(cavity) < 1024:
                x, y, w = self.corner(edge), self.corner(other), self.corner(before(other))
                vx, vy, vw = self.vertices[x], self.vertices[y], self.vertices[w]
                if area2(at, vx, vw) > 0 and area2(at, vw, vy) > 0:
                    fan = x in common or y in common
                    if coder.bit(self.models.inside[fan][min(len(cavity), 4) - 1][angle_class(at, vw, vx, vy)]):
                        common &= {x, y}
                        cavity.append(other[0])
                        stack += [before(other), behind(other)]
                        continue
            outer.append(edge)
        return cavity, outer, bool(under) and self.beyond[t][under[1]] is None

    def plane(self, t, at):
        p, q, r = (self.vertices[v] for v in self.triangles[t])
        whole = float(area2(p, q, r))
        return p[2] + area2(p, at, r) / whole * (q[2] - p[2]) + area2(p, q, at) / whole * (r[2] - p[2])

    def height(self, coder, t, at, is_open):
        length, size, node = 0, 0, 0
        while length < 31 and coder.bit(self.models.length[is_open][length]):
            length += 1
        for i in range(length):
            if i == 0:
                size = 1
            elif i <= 2:
                bit = coder.bit(self.models.behind[is_open][length][node])
                size, node = 2 * size + bit, 1 + bit
            else:
                size = 2 * size + coder.number(2)
        if size:
            far = [self.vertices[self.corner(before(edge))] for edge in self.beyond[t] if edge]
            above = sum(vertex[2] > self.plane(t, vertex) for vertex in far)
            size = -size if coder.bit(self.models.sign[above]) else size
        return (math.floor(self.plane(t, at) / self.step + 0.5) + size) * self.step

    def fan(self, cavity, outer, is_open):
        apex, slots, sides = len(self.vertices) - 1, [], []
        ends = [(self.corner(edge), self.corner(behind(edge)), self.beyond[edge[0]][edge[1]]) for edge in outer]
        left = [t for t in cavity if t not in {edge[0] for edge in outer}]
        for edge in outer:
            own = edge[0] not in slots
            slots.append(edge[0] if own else None)
            sides.append(edge[1] if own else 0)
        for i, slot in enumerate(slots):
            if slot is None:
                slots[i] = left.pop(0) if left else len(self.triangles)
                if slots[i] == len(self.triangles):
                    self.triangles.append(None)
                    self.beyond.append(None)
        for slot, side, (a, b, _) in zip(slots, sides, ends):
            corners = [apex] * 3
            corners[side], corners[(side + 1) % 3] = a, b
            self.triangles[slot], self.beyond[slot] = corners, [None] * 3
        for slot, side, (_, _, other) in zip(slots, sides, ends):
            self.beyond[slot][side] = other
            if other:
                self.beyond[other[0]][other[1]] = (slot, side)
        for i in range(1 if is_open else 0, len(slots)):
            leaving, coming = behind((slots[i - 1], sides[i - 1])), before((slots[i], sides[i]))
            self.beyond[leaving[0]][leaving[1]], self.beyond[coming[0]][coming[1]] = coming, leaving
        return slots


def read(data):
    size, = struct.unpack_from('<H', data, 10)
    rungs, extensions = struct.unpack_from('<HH', data, 16)
    assert data[:8] == b'\x89Scree\r\n' and size == 88 + 30 * rungs + extensions, 'the header is not one'
    assert zlib.crc32(data[:size - 4]) == struct.unpack_from('<I', data, size - 4)[0], 'the header is damaged'
    mesh, at = Mesh(*struct.unpack_from('<ii', data, 28)), size
    for rung in range(rungs):
        _, vertices, triangles, _, _, _, block_size, checksum = struct.unpack_from('<hIIfffII', data, 84 + 30 * rung)
        block = data[at:at + block_size]
        assert zlib.crc32(block) == checksum, 'a block is damaged'
        coder, at = Coder(block), at + block_size
        layers = coder.number(128) + 1 if rung else mesh.start(coder)
        for _ in range(layers):
            mesh.layer(coder)
        if rung == 0:
            mesh.models = Models()
        assert coder.is_spent() and len(mesh.vertices) == vertices and len(mesh.triangles) == triangles, \
            'block %d does not come out' % rung
    assert at == len(data), 'the file does not end with its last block'
    areas = [area2(*(mesh.vertices[v] for v in triangle)) for triangle in mesh.triangles]
    assert min(areas) > 0 and sum(areas) == 2 * mesh.columns * mesh.rows, 'the tile is not covered once'
    return mesh


def main():
    for path in sys.argv[1:]:
        with open(path, 'rb') as file:
            mesh = read(file.read())
        print('%s: %d vertices, %d triangles' % (path, len(mesh.vertices), len(mesh.triangles)))


if __name__ == '__main__':
    main()
