#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""Pairs of photographs of furnished rooms, with true poses: global illumination, soft shadows, real furniture.

    render.py FOLDER [--first N] [--last N] [--views N] [--models DIR]

Needs Blender as a Python module (pip install bpy) and the models of Debian's package sweethome3d-furniture, of which nothing is
kept here. Every room has walls in one or two colours, a floor of wood, tiles or carpet, windows, a door, furniture along its walls,
pictures and lamps, all drawn by its number; its views look at one wall in directions that are 8 to 65 degrees apart. 640 x 480 px,
focal length 520 to 600 px, three kinds of tone curves, exposures up to a stop apart, blur .6 px, noise 2, JPEG 93.
Every pair of views becomes a folder FOLDER/ROOM_VIEWS with 1.png, 2.png and truth.json: F, K1, K2, pose (3 x 4, x2 ~ R x1 + t) and
`common`, the smaller share of either image that the other one shows. A view takes 20 s of a processor and more.
"""

import argparse
import io
import itertools
import json
import math
import pathlib
import random
import re
import sys
import tempfile
import zipfile

import bpy
import numpy as np
from mathutils import Matrix, Vector
from PIL import Image, ImageFilter

WIDTH, HEIGHT = 640, 480
DEPTH_STEP = 8  # px between samples of the depth
SIDES = 4  # walls: far (y = depth), right (x = width), near (y = 0), left (x = 0)
INWARDS = (0, -math.pi / 2, math.pi, math.pi / 2)  # how what stands before a wall is turned
PLACES = (("Living room", "Miscellaneous"), ("Bedroom", "Living room"), ("Office", "Living room"), ("Kitchen", "Living room"))
WOODS = ((0.35, 0.2, 0.1), (0.5, 0.33, 0.18), (0.25, 0.15, 0.09), (0.55, 0.45, 0.33))


# --- furniture -----------------------------------------------------------------------------------------------------------------


def unpack(models, into):
    """The catalogues' models, with their sizes in m."""
    found = []
    for archive in sorted(models.glob("*.sh3f")):
        folder = into / archive.stem
        zipfile.ZipFile(archive).extractall(folder)
        entries = {}
        for line in (folder / "PluginFurnitureCatalog.properties").read_text(encoding="latin1").splitlines():
            parts = re.match(r"(\w+)#(\d+)=(.*)", line.strip())
            if parts:
                entries.setdefault(parts[2], {})[parts[1]] = parts[3]
        for entry in entries.values():
            path = folder / entry.get("model", "/").lstrip("/")
            if path.suffix == ".obj" and path.exists():
                size = [float(entry[side]) / 100 for side in ("width", "depth", "height")]
                found.append({"path": path, "size": size, "kind": entry.get("category", ""), "high": "elevation" in entry,
                              "opening": entry.get("doorOrWindow", "false") == "true"})
    return found


def fits(model, least, most):
    return all(a <= b <= c for a, b, c in zip(least, model["size"], most))


# --- a room --------------------------------------------------------------------------------------------------------------------


class Room:
    def __init__(self, number, models):
        self.models, self.random = models, random.Random(number)
        bpy.ops.wm.read_factory_settings(use_empty=True)
        self.width, self.depth, self.height = self.uniform(4, 6.5), self.uniform(3.6, 5.5), self.uniform(2.4, 2.9)
        self.lengths = (self.width, self.depth, self.width, self.depth)
        self.taken = [[] for _ in range(SIDES)]  # from, to, kind
        self.white = self.material((0.8, 0.8, 0.78), 0.7)
        self.build_shell()
        self.build_openings()
        for side in range(SIDES):
            self.furnish(side)
        if self.random.random() < 0.6:
            self.place_table()
        for _ in range(self.random.choice((1, 1, 2))):
            self.hang_lamp()
        bpy.context.scene.world = bpy.data.worlds.new("world")

    def uniform(self, low, high):
        return self.random.uniform(low, high)

    def pastel(self, low=0.45, high=0.85):
        gray = self.uniform(low, high)
        shifts = (self.uniform(-0.08, 0.1), self.uniform(-0.05, 0.05), self.uniform(-0.12, 0.08))
        return tuple(min(max(gray + shift, 0), 1) for shift in shifts)

    def material(self, colour, roughness=0.6, texture=None, **inputs):
        """`texture`: a node whose inputs, and `turned` radians, are given."""
        made = bpy.data.materials.new("material")
        made.use_nodes = True
        tree, surface = made.node_tree, made.node_tree.nodes["Principled BSDF"]
        surface.inputs["Base Color"].default_value = (*colour, 1)
        surface.inputs["Roughness"].default_value = roughness
        if texture:
            place, turn = tree.nodes.new("ShaderNodeTexCoord"), tree.nodes.new("ShaderNodeMapping")
            node = tree.nodes.new(texture)
            turn.inputs["Rotation"].default_value = (0, 0, inputs.pop("turned", 0))
            node.offset = inputs.pop("offset", 0.5)
            for name, value in inputs.items():
                node.inputs[name.replace("_", " ")].default_value = value
            tree.links.new(place.outputs["Object"], turn.inputs["Vector"])
            tree.links.new(turn.outputs["Vector"], node.inputs["Vector"])
            tree.links.new(node.outputs["Color"], surface.inputs["Base Color"])
        return made

    def box(self, low, high, material):
        bpy.ops.mesh.primitive_cube_add(size=1, location=[(a + b) / 2 for a, b in zip(low, high)])
        made = bpy.context.object
        made.scale = [b - a for a, b in zip(low, high)]
        bpy.ops.object.transform_apply(location=False, rotation=False, scale=True)
        made.data.materials.append(material)

    def at_wall(self, side, along, off):
        return ((along, self.depth - off), (self.width - off, along), (along, off), (off, along))[side]

    def panel(self, side, along, up, off, material):
        """A box before a wall: from, to in each direction."""
        a, b = self.at_wall(side, along[0], off[0]), self.at_wall(side, along[1], off[1])
        self.box((min(a[0], b[0]), min(a[1], b[1]), up[0]), (max(a[0], b[0]), max(a[1], b[1]), up[1]), material)

    def floor(self):
        kind = self.random.choice(("wood", "wood", "tiles", "carpet"))
        if kind == "carpet":
            return self.material(self.pastel(0.15, 0.6), 0.95)
        if kind == "tiles":
            size, colour = self.uniform(0.25, 0.6), self.pastel(0.3, 0.8)
            look = {"Brick_Width": size, "Row_Height": size, "Mortar_Size": 0.005, "offset": 0.0}
            second, mortar, roughness = 0.97, 0.5, 0.2
        else:
            colour, second, mortar, roughness = self.random.choice(WOODS), self.uniform(0.75, 0.9), 0.4, 0.35
            look = {"Brick_Width": 1.2, "Row_Height": self.uniform(0.1, 0.2), "Mortar_Size": 0.003,
                    "turned": self.random.choice((0, math.pi / 2))}
        darker = [(*(c * share for c in colour), 1) for share in (second, mortar)]
        return self.material(colour, roughness, "ShaderNodeTexBrick", Color1=(*colour, 1), Color2=darker[0], Mortar=darker[1],
                             Scale=1.0, **look)

    def build_shell(self):
        w, d, h, thick = self.width, self.depth, self.height, 0.12
        walls = [self.material(self.pastel(), 0.8)] * SIDES
        if self.random.random() < 0.5:
            walls[self.random.randrange(SIDES)] = self.material(self.pastel(), 0.8)
        self.box((-thick, -thick, -thick), (w + thick, d + thick, 0), self.floor())
        self.box((-thick, -thick, h), (w + thick, d + thick, h + thick), self.white)
        skirting = self.material(self.random.choice(((0.8, 0.8, 0.8), (0.3, 0.18, 0.1), self.pastel())), 0.4)
        high, moulding = self.uniform(0.06, 0.12), self.random.random() < 0.4
        for side in range(SIDES):
            ends = (-thick, self.lengths[side] + thick)
            self.panel(side, ends, (0, h), (-thick, 0), walls[side])
            self.panel(side, (0, self.lengths[side]), (0, high), (0, 0.015), skirting)
            if moulding:
                self.panel(side, (0, self.lengths[side]), (h - 0.06, h), (0, 0.05), self.white)

    def build_openings(self):
        windows = self.random.sample(range(SIDES), self.random.choice((1, 1, 2)))
        for side in windows:
            wide = self.uniform(0.9, min(2.4, self.lengths[side] / 2))
            middle = self.uniform(wide / 2 + 0.4, self.lengths[side] - wide / 2 - 0.4)
            self.cut_window(side, middle - wide / 2, middle + wide / 2)
        doors = [m for m in self.models if m["opening"] and fits(m, (0.6, 0, 1.8), (1.2, 0.5, 2.3))]
        side = self.random.choice([k for k in range(SIDES) if k not in windows])
        door, middle = self.random.choice(doors), self.uniform(0.8, self.lengths[side] - 0.8)
        self.put(door, *self.at_wall(side, middle, door["size"][1] / 2 - 0.05), INWARDS[side])
        self.taken[side].append((middle - door["size"][0] / 2 - 0.1, middle + door["size"][0] / 2 + 0.1, "door"))

    def cut_window(self, side, left, right):
        low = self.uniform(0.8, 1)
        high, bars, thick = low + self.uniform(0.9, 1.3), self.random.choice((1, 2, 2, 3)), 0.06
        sky = bpy.data.materials.new("sky")
        sky.use_nodes = True
        light = sky.node_tree.nodes.new("ShaderNodeEmission")
        light.inputs["Color"].default_value, light.inputs["Strength"].default_value = (0.85, 0.93, 1, 1), self.uniform(4, 9)
        sky.node_tree.links.new(light.outputs[0], sky.node_tree.nodes["Material Output"].inputs[0])
        self.panel(side, (left, right), (low, high), (0.001, 0.006), sky)
        for edge in (low - thick, high):
            self.panel(side, (left - thick, right + thick), (edge, edge + thick), (0, 0.05), self.white)
        for bar in range(bars + 1):
            middle = left + (right - left) * bar / bars
            self.panel(side, (middle - thick / 2, middle + thick / 2), (low, high), (0, 0.05), self.white)
        self.taken[side].append((left, right, "window"))

    def hang_picture(self, side, middle):
        w, h, low = self.uniform(0.3, 0.9), self.uniform(0.3, 0.7), self.uniform(1.3, 1.5)
        left, right = middle - w / 2, middle + w / 2
        if left < 0.05 or right > self.lengths[side] - 0.05 or any(left < b and right > a for a, b, _ in self.taken[side]):
            return
        frame = self.material(self.random.choice(((0.05, 0.05, 0.05), (0.3, 0.2, 0.1), (0.7, 0.7, 0.7))))
        self.panel(side, (left - 0.03, right + 0.03), (low - 0.03, low + h + 0.03), (0, 0.02), frame)
        self.panel(side, (left, right), (low, low + h), (0, 0.022), self.material(self.pastel(0.5, 0.9)))
        for layer in range(self.random.randint(3, 9)):
            across = sorted(self.uniform(left + 0.02, right - 0.02) for _ in range(2))
            up = sorted(self.uniform(low + 0.02, low + h - 0.02) for _ in range(2))
            colour = tuple(self.uniform(0.05, 0.9) for _ in range(3))
            self.panel(side, across, up, (0, 0.0225 + 0.0004 * layer), self.material(colour))
        self.taken[side].append((left - 0.05, right + 0.05, "picture"))

    def put(self, model, x, y, turned):
        before = set(bpy.data.objects)
        bpy.ops.wm.obj_import(filepath=str(model["path"]))
        new = [o for o in bpy.data.objects if o not in before]
        corners = np.array([o.matrix_world @ Vector(c) for o in new for c in o.bound_box])
        low, high = corners.min(0), corners.max(0)
        size = Matrix.Diagonal((*(np.array(model["size"]) / np.maximum(high - low, 1e-4)), 1))
        middle = Matrix.Translation((-(low[0] + high[0]) / 2, -(low[1] + high[1]) / 2, -low[2]))
        moved = Matrix.Translation((x, y, 0)) @ Matrix.Rotation(turned, 4, "Z") @ size @ middle
        for o in new:
            if o.parent is None:
                o.matrix_world = moved @ o.matrix_world

    def furnish(self, side):
        kinds = self.random.choice(PLACES)
        models = [m for m in self.models if m["kind"] in kinds and not m["opening"] and not m["high"] and
                  fits(m, (0.3, 0.2, 0.3), (2.6, 1.1, 2.3))]
        length, along = self.lengths[side], self.uniform(0.05, 0.5)
        while along < length - 0.5:
            model = self.random.choice(models)
            wide, deep, high = model["size"]
            end = along + wide
            in_corner = side % 2 == 1 and (along < 0.9 or end > length - 0.9)  # of the walls to either side
            hides = any(along < b and end > a and (kind == "door" or high > 0.85) for a, b, kind in self.taken[side])
            if end > length - 0.1 or in_corner or hides:
                along += 0.5
                continue
            self.put(model, *self.at_wall(side, along + wide / 2, deep / 2 + 0.02), INWARDS[side])
            if high < 1.1 and self.random.random() < 0.5:
                self.hang_picture(side, along + wide / 2)
            along = end + self.random.choice((0.05, 0.3, 0.8, 1.2))

    def place_table(self):
        models = [m for m in self.models if m["kind"] in ("Living room", "Kitchen", "Office") and not m["opening"] and
                  fits(m, (0.5, 0.4, 0.3), (1.6, 1.2, 0.8))]
        self.put(self.random.choice(models), self.width / 2 + self.uniform(-0.5, 0.5), self.depth / 2 + self.uniform(-0.4, 0.4),
                 self.random.choice((0, math.pi / 2, self.uniform(0, 6))))

    def hang_lamp(self):
        lamp = bpy.data.lights.new("lamp", "AREA")
        lamp.energy, lamp.size = self.uniform(25, 80), self.uniform(0.3, 0.7)
        lamp.color = (1, self.uniform(0.8, 0.95), self.uniform(0.6, 0.85))
        made = bpy.data.objects.new("lamp", lamp)
        made.location = (self.uniform(0.25, 0.75) * self.width, self.uniform(0.25, 0.75) * self.depth, self.height - 0.03)
        bpy.context.scene.collection.objects.link(made)


# --- views ---------------------------------------------------------------------------------------------------------------------


def free_way(start, direction, most=20.0):
    """m to what is seen there first."""
    graph = bpy.context.evaluated_depsgraph_get()
    hit, place, *_ = bpy.context.scene.ray_cast(graph, Vector(start), Vector(direction), distance=most)
    return (Vector(start) - place).length if hit else most


def is_among_things(place):
    around = itertools.product(np.arange(0, 2 * math.pi, 0.4), (-0.7, 0, 0.4))
    return any(free_way(place, (math.cos(angle), math.sin(angle), up)) < 0.35 for angle, up in around)


def choose_stands(room, count):
    """Where cameras stand, as matrices of Blender (y is up in the image, -z is ahead)."""
    side = room.random.randrange(SIDES)
    along = room.uniform(0.35, 0.65) * room.lengths[side]
    target = Vector((*room.at_wall(side, along, 0.3), room.uniform(0.7, 1.3)))
    stands = []
    for _ in range(3000):
        if len(stands) == count:
            break
        place = Vector((room.uniform(0.6, room.width - 0.6), room.uniform(0.6, room.depth - 0.6), room.uniform(1.1, 1.75)))
        aim = target + Vector([room.uniform(-0.5, 0.5) * s for s in (1, 1, 0.6)])
        ahead = (aim - place).normalized()
        if (place - target).length < 1.8 or is_among_things(place) or free_way(place, ahead) < 1.2:
            continue
        if all((place - other).length > 0.5 and 8 < math.degrees(ahead.angle(way)) < 65 for _, other, way in stands):
            roll = Matrix.Rotation(math.radians(room.random.gauss(0, 3)), 4, "Z")
            turn = ahead.to_track_quat("-Z", "Y").to_matrix().to_4x4()
            stands.append((Matrix.Translation(place) @ turn @ roll, place, ahead))
    return [matrix for matrix, _, _ in stands]


def prepare_renderer():
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = WIDTH, HEIGHT
    scene.render.image_settings.file_format = "PNG"
    scene.cycles.samples, scene.cycles.max_bounces, scene.cycles.use_denoising = 14, 4, True


def render(room, camera, stand, path):
    """As a camera writes it."""
    scene = bpy.context.scene
    camera.matrix_world = stand
    scene.view_settings.view_transform = room.random.choice(("AgX", "Filmic", "Standard"))
    scene.view_settings.exposure = room.uniform(-0.3, 0.6)
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    seen = np.asarray(Image.open(path).convert("RGB").filter(ImageFilter.GaussianBlur(0.6)), float)
    noise = np.random.default_rng(room.random.getrandbits(32)).normal(0, 2, seen.shape)
    packed = io.BytesIO()
    Image.fromarray(np.clip(seen + noise, 0, 255).round().astype(np.uint8)).save(packed, "JPEG", quality=93)
    Image.open(packed).save(path)


def look(stand, inner):
    """The pose of a view, x = R X + t, and its depths."""
    to_world = np.array(stand)[:3, :3] @ np.diag([1.0, -1.0, -1.0])
    place = np.array(stand)[:3, 3]
    depths = np.empty((HEIGHT // DEPTH_STEP, WIDTH // DEPTH_STEP))
    for row, column in np.ndindex(*depths.shape):
        ray = np.linalg.inv(inner) @ (column * DEPTH_STEP, row * DEPTH_STEP, 1)
        length = np.linalg.norm(ray)
        depths[row, column] = free_way(place, to_world @ ray / length) / length
    return to_world.T, -to_world.T @ place, depths


def share_seen(inner, first, second):
    """Of what the first view shows, how much does the second one?"""
    (rotation1, shift1, depths1), (rotation2, shift2, depths2) = first, second
    rows, columns = np.mgrid[: depths1.shape[0], : depths1.shape[1]] * DEPTH_STEP
    rays = np.stack([columns, rows, np.ones_like(rows)], -1) @ np.linalg.inv(inner).T
    there = ((rays * depths1[..., None] - shift1) @ rotation1) @ rotation2.T + shift2
    depth = np.maximum(there[..., 2], 1e-6)
    at = np.floor((there @ inner.T)[..., :2] / depth[..., None] / DEPTH_STEP + 0.5).astype(int)
    inside = (there[..., 2] > 0.1) & (at >= 0).all(-1) & (at[..., 0] < depths2.shape[1]) & (at[..., 1] < depths2.shape[0])
    seen = depths2[np.where(inside, at[..., 1], 0), np.where(inside, at[..., 0], 0)]
    return float(np.mean(inside & (np.abs(seen - depth) < 0.08 * depth)))


def truth_of(inner, first, second):
    rotation = second[0] @ first[0].T
    shift = second[1] - rotation @ first[1]
    cross = np.array([[0, -shift[2], shift[1]], [shift[2], 0, -shift[0]], [-shift[1], shift[0], 0]])
    inverse = np.linalg.inv(inner)
    return {"kind": "fundamental", "H": None, "wref": None, "lines": None, "F": (inverse.T @ cross @ rotation @ inverse).tolist(),
            "K1": inner.tolist(), "K2": inner.tolist(), "pose": np.column_stack([rotation, shift]).tolist(),
            "common": min(share_seen(inner, first, second), share_seen(inner, second, first))}


def make_room(number, count, models, folder, work):
    room = Room(number, models)
    stands, focal = choose_stands(room, count), room.uniform(520, 600)
    inner = np.array([[focal, 0, (WIDTH - 1) / 2], [0, focal, (HEIGHT - 1) / 2], [0, 0, 1]])
    lens = bpy.data.cameras.new("camera")
    lens.sensor_width, lens.lens, lens.clip_start = 36, focal * 36 / WIDTH, 0.02
    camera = bpy.data.objects.new("camera", lens)
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera
    prepare_renderer()
    views = []
    for n, stand in enumerate(stands):
        path = work / f"{number}_{n}.png"
        render(room, camera, stand, path)
        views.append((path.read_bytes(), look(stand, inner)))
    for (n, first), (m, second) in itertools.combinations(enumerate(views), 2):
        pair = folder / f"{number:03}_{n}{m}"
        pair.mkdir(parents=True, exist_ok=True)
        (pair / "1.png").write_bytes(first[0])
        (pair / "2.png").write_bytes(second[0])
        (pair / "truth.json").write_text(json.dumps(truth_of(inner, first[1], second[1])))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--last", type=int, default=20)
    parser.add_argument("--views", type=int, default=3)
    parser.add_argument("--models", type=pathlib.Path, default="/usr/share/sweethome3d/furniture")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as place:
        work = pathlib.Path(place)
        models = unpack(given.models, work)
        if not models:
            sys.exit(f"{given.models} has no models (*.sh3f)")
        for number in range(given.first, given.last + 1):
            make_room(number, given.views, models, given.folder, work)
            print(f"room {number}", flush=True)


if __name__ == "__main__":
    main()
