"""Files made by hand to do harm, by what reads them: for the tests, and as seeds of the fuzzer."""

import os
import shutil
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Final

from treadwell.data import data_folder

HEAD: Final = 'schema = 1\nname = "x"\n[start]\n[goal]\n'
Make = Callable[[Path], None]
"""Puts a file where the path is."""


def text(content: str) -> Make:
    return lambda path: path.write_text(content, encoding="utf-8") and None


def data(content: bytes) -> Make:
    return lambda path: path.write_bytes(content) and None


def link(target: str) -> Make:
    return lambda path: path.symlink_to(target)


def pipe(path: Path) -> None:
    os.mkfifo(path)


def large(path: Path) -> None:
    """A gigabyte of nothing, that takes no room on the disk."""
    with path.open("wb") as file:
        file.truncate(1 << 30)


NO_FILE: Final[dict[str, Make]] = {
    "a gigabyte": large,
    "a pipe": pipe,
    "an endless device": link("/dev/zero"),
    "a link to itself": lambda path: path.symlink_to(path.name),
    "a folder": lambda path: path.mkdir(),
    "nothing": data(b""),
    "noise": data(bytes(range(256)) * 40),
    "half of a letter": data(b"\xc3"),
    "sixteen bits": data('<?xml version="1.0" encoding="utf-16"?><mujoco/>'.encode("utf-16")),
    "zeros": data(bytes(10_000)),
}
"""What may lie in any file's place."""


def toml(body: str) -> Make:
    return text(HEAD + body)


def element(body: str) -> Make:
    return toml(f"[[course]]\n{body}\n")


BOX: Final = 'kind = "box"\n'
SCENARIOS: Final[dict[str, Make]] = NO_FILE | {
    "deep list": text("a = " + "[" * 50_000),
    "deep table": text("a" + ".a" * 100_000 + " = 1"),
    "deep inline": text("a = " + "{a = " * 5_000),
    "long number": text(f"schema = {'9' * 10_000}"),
    "long float": toml(f"[physics]\nfriction = 0.{'3' * 300_000}e999"),
    "long key": text(f"{'k' * 500_000} = 1"),
    "control characters": text('schema = 1\nname = "\x00\x1b[2J"'),
    "a key twice": text("schema = 1\nschema = 1"),
    "path in the name": text(HEAD.replace('"x"', '"../../etc/x"')),
    "newline in the name": text(HEAD.replace('"x"', '"a\\nb"')),
    "markup in the name": text(HEAD.replace('"x"', '"<script>"')),
    "empty name": text(HEAD.replace('"x"', '""')),
    "long name": text(HEAD.replace('"x"', f'"{"x" * 10_000}"')),
    "schema 2": text(HEAD.replace("schema = 1", "schema = 2")),
    "schema as a word": text(HEAD.replace("schema = 1", 'schema = "1"')),
    "a cell of an atom": toml("[navigation.fog]\ncell = 1e-12"),
    "NaN in the start": text(HEAD.replace("[start]", "[start]\nyaw = nan")),
    "infinity in the goal": text(HEAD.replace("[goal]", "[goal]\nposition = [inf, 0.0]")),
    "a far goal": text(HEAD.replace("[goal]", "[goal]\nposition = [1e308, 0.0]")),
    "a flat goal": text(HEAD.replace("[goal]", "[goal]\nposition = [1.0]")),
    "a goal without room": text(HEAD.replace("[goal]", "[goal]\nradius = 0.0")),
    "endless via": text(HEAD.replace("[goal]", f"[goal]\nvia = [{'[0.0, 0.0],' * 5000}]")),
    "no time": text("time_limit = 0.0\n" + HEAD),
    "time that runs back": text("time_limit = -5.0\n" + HEAD),
    "time without end": text("time_limit = inf\n" + HEAD),
    "years": text("time_limit = 1e12\n" + HEAD),
    "negative seed": text("seed = -1\n" + HEAD),
    "huge seed": text(f"seed = {2**63}\n" + HEAD),
    "float seed": text("seed = 0.5\n" + HEAD),
    "robot outside": text('robot = "../../../etc"\n' + HEAD),
    "robot with a zero byte": text('robot = "a\\u0000b"\n' + HEAD),
    "robot that is none": text('robot = "/tmp"\n' + HEAD),
    "no friction": toml("[physics]\nfriction = -0.1"),
    "friction NaN": toml("[physics]\nfriction = nan"),
    "mass without end": toml("[physics]\nmass_scale = inf"),
    "mass of nothing": toml("[physics]\nmass_scale = 0.0"),
    "negative latency": toml("[sensors]\nlatency = -1.0"),
    "unknown table": toml("[sudo]\nx = 1"),
    "unknown kind": element('kind = "ladder"'),
    "no kind": element("position = [0.0, 0.0]"),
    "box of NaN": element(BOX + "size = [nan, 1.0, 1.0]"),
    "box of nothing": element(BOX + "size = [0.0, 1.0, 1.0]"),
    "box inside out": element(BOX + "size = [-1.0, 1.0, 1.0]"),
    "box of a universe": element(BOX + "size = [1e300, 1.0, 1.0]"),
    "box of words": element(BOX + 'size = ["1", "1", "1"]'),
    "box far away": element(BOX + "position = [1e9, 0.0]"),
    "texture": element(BOX + "texture = 2.0"),
    "a name that is a number": element(BOX + 'name = "0"'),
    "a name with dots": element(BOX + 'name = "a.b"'),
    "a name with markup": element(BOX + 'name = "<img>"'),
    "too many": toml(f"[[course]]\n{BOX}" * 2001),
    "a million": text(HEAD + "course = [" + '{kind="box"},' * 60_000 + "]"),
    "endless steps": element('kind = "stairs"\nsteps = 1000000000'),
    "no steps": element('kind = "stairs"\nsteps = 0'),
    "steps of NaN": element('kind = "stairs"\nrise = [nan, 0.1, 0.1, 0.1]'),
    "too few rises": element('kind = "stairs"\nsteps = 4\nrise = [0.1]'),
    "stairs down a hole": element('kind = "stairs"\nrise = -0.1'),
    "scatter of millions": element('kind = "scatter"\ncount = 1000000000'),
    "scatter inside out": element('kind = "scatter"\nsize = [0.3, 0.1]'),
    "scatter on nothing": element('kind = "scatter"\narea = [[1.0, 1.0], [1.0, 1.0]]'),
    "scatter without a way": element(
        'kind = "scatter"\ncount = 100\narea = [[0.3,-0.3],[0.9,0.3]]'
    ),
    "a house of no rooms": element('kind = "house"\nrooms = 0'),
    "a house without a place": element('kind = "house"\nrooms = 12'),
    "a house elsewhere": element('kind = "house"\narea = [[9.0, 9.0], [12.0, 12.0]]'),
    "a house of dragons": element('kind = "house"\nthings = ["dragon"]'),
    "a yard of clutter": element('kind = "yard"\nclutter = 60\narea = [[-0.5,-0.5],[2.5,0.5]]'),
    "a yard inside out": element('kind = "yard"\narea = [[1.0, 1.0], [-1.0, -1.0]]'),
    "flights of no shape": element('kind = "flights"\nshapes = []'),
    "flights inside out": element('kind = "flights"\ntread = [0.2, 0.1]'),
    "a million slabs": element('kind = "slabs"\nedge = 0.001'),
    "a door of no width": element('kind = "door"\nwidth = 0.0'),
    "a door more than open": element('kind = "door"\nopen = 1.5'),
    "a door that is not": toml('[[event]]\nat = 1.0\ndo = "set_door"\nname = "a"\nopen = 1.0'),
    "a path of nothing": toml('[[event]]\nat = 1.0\ndo = "move"\nname = "a"\npath = []'),
    "a move to nowhere": toml('[[event]]\nat = 1.0\ndo = "move"\nname = "a"'),
    "rubble of mountains": element('kind = "rubble"\namplitude = 1e6'),
    "a patch of NaN": element('kind = "patch"\nfriction = nan'),
    "a jungle": element('kind = "vegetation"\nsize = [90.0, 90.0]\ndensity = 20000.0'),
    "a terrain of ripples": element('kind = "terrain"\nwavelength = 1e-300'),
    "an outer terrain": element('kind = "terrain"\nfile = "/etc/passwd"'),
    "a terrain of two kinds": element('kind = "terrain"\nfile = "x.png"\nwavelength = 1.0'),
    "a wall of no length": element('kind = "wall"\nfrom = [1.0, 1.0]\nto = [1.0, 1.0]'),
    "an event of no kind": toml("[[event]]\nat = 1.0"),
    "an event before time": toml('[[event]]\nat = -1.0\ndo = "blind"\nduration = 1.0'),
    "a push of NaN": toml('[[event]]\nat = 1.0\ndo = "push"\nimpulse = [nan, 0.0, 0.0]'),
    "a push of a planet": toml('[[event]]\nat = 1.0\ndo = "push"\nimpulse = [1e300, 0.0, 0.0]'),
    "too many events": toml('[[event]]\nat = 1.0\ndo = "blind"\nduration = 1.0\n' * 201),
    "a joint that is not": toml(
        '[[event]]\nat = 1.0\ndo = "encoder_offset"\njoint = "tail"\nvalue = 0.1'
    ),
    "deep parameters": toml("[navigation.fog]\ncell = " + "{a = " * 50 + "1" + "}" * 50),
    "long parameters": toml(f"[navigation.fog]\ncell = [{'1,' * 20_000}]"),
    "NaN for the core": toml("[navigation.fog]\ncell = nan"),
    "a cell of nothing": toml("[navigation.fog]\ncell = 0.0"),
    "a number of 65 bits": toml(f"[navigation.fog]\ncell = {2**64}"),
    "a date for the core": toml("[navigation.fog]\ncell = 2020-01-01"),
    "a part that is a path": toml('[navigation]\nplanner = "../x:Y"'),
    "a part that is code": toml('[navigation]\nplanner = "os:system(1)"'),
    "a part that is no part": toml('[navigation]\nplanner = "os:getcwd"'),
    "a part that is not there": toml('[navigation]\nplanner = "no_such_module_at_all:Thing"'),
    "draws of nothing": toml('[vary]\n"start.yaw" = { choice = [] }'),
    "draws of NaN": toml('[vary]\n"start.yaw" = { uniform = [nan, 1.0] }'),
    "draws inside out": toml('[vary]\n"start.yaw" = { uniform = [1.0, 0.0] }'),
    "draws by the hundred": toml("[vary]\n" + "".join(f'"a{i}" = {{}}\n' for i in range(200))),
    "draws of the schema": toml('[vary]\n"schema" = { choice = [2] }'),
    "draws along a number": toml('[vary]\n"start.yaw.deep" = { uniform = [0.0, 1.0] }'),
    "a course of a pipe": text('course_of = "/dev/zero"\n' + HEAD),
    "a course of outside": text('course_of = "../x.toml"\n' + HEAD),
    "a course of itself": text('course_of = "x.toml"\n' + HEAD),
    "a mesh of outside": element('kind = "mesh"\nfile = "../x.stl"'),
    "a mesh of a system file": element('kind = "mesh"\nfile = "/etc/passwd"'),
    "a mesh with a zero byte": element('kind = "mesh"\nfile = "a\\u0000.stl"'),
    "a mesh that is a folder": element('kind = "mesh"\nfile = "."'),
    "a world of outside": element('kind = "mjcf"\nfile = "../../x.xml"'),
    "expected NaN": toml("[expect]\nmax_time = nan"),
    "expected a fall": toml('[expect]\noutcome = "fell"'),
}

WORLD: Final = "<mujoco><worldbody>{}</worldbody></mujoco>"


def world(inside: str) -> Make:
    return text(WORLD.format(inside))


def model(inside: str) -> Make:
    return text(f"<mujoco>{inside}</mujoco>")


LAUGHS: Final = "".join(f'<!ENTITY l{i + 1} "{f"&l{i};" * 10}">' for i in range(12))
WORLDS: Final[dict[str, Make]] = NO_FILE | {
    "laughs": text(f'<!DOCTYPE m [<!ENTITY l0 "ha">{LAUGHS}]><mujoco>&l12;</mujoco>'),
    "an outer entity": text(
        '<!DOCTYPE m [<!ENTITY x SYSTEM "file:///etc/passwd">]><mujoco>&x;</mujoco>'
    ),
    "a document type": text('<!DOCTYPE mujoco SYSTEM "http://localhost/x.dtd"><mujoco/>'),
    "a parameter entity": text('<!DOCTYPE m [<!ENTITY % p SYSTEM "x"> %p;]><mujoco/>'),
    "laughs of sixteen bits": data(
        f'<!DOCTYPE m [<!ENTITY l0 "ha">{LAUGHS}]><mujoco>&l12;</mujoco>'.encode("utf-16")
    ),
    "another root": text("<robot name='x'><link name='a'/></robot>"),
    "two roots": text("<mujoco/><mujoco/>"),
    "no end": text("<mujoco><worldbody>"),
    "deep bodies": world("<body>" * 5_000 + "</body>" * 5_000),
    "deep anything": text("<mujoco>" + "<a>" * 100_000 + "</a>" * 100_000 + "</mujoco>"),
    "many elements": world("<geom size='1'/>" * 30_000),
    "a long attribute": world(f"<geom name='{'x' * 6_000_000}' size='1'/>"),
    "nested copies": world("<replicate count='3000'><replicate count='3000'><geom size='1'/>"
                           "</replicate></replicate>"),
    "copies of copies": world(
        "<replicate count='10'>" * 6 + "<geom size='1'/>" + "</replicate>" * 6
    ),
    "copies of many": world("<replicate count='2000'>" + "<geom size='1'/>" * 50 + "</replicate>"),
    "copies by a word": world("<replicate count='many'><geom size='1'/></replicate>"),
    "copies by a float": world("<replicate count='1e9'><geom size='1'/></replicate>"),
    "heights": model("<asset><hfield name='h' nrow='60000' ncol='60000' size='1 1 1 1'/></asset>"),
    "negative heights": model(
        "<asset><hfield name='h' nrow='-6' ncol='9' size='1 1 1 1'/></asset>"
    ),
    "texture": model("<asset><texture name='t' type='2d' builtin='flat' width='90000' "
                     "height='90000'/></asset>"),
    "memory": model("<size memory='900G'/><worldbody><geom size='1'/></worldbody>"),
    "user data": model("<size nuserdata='2000000000'/>"),
    "NaN size": world("<geom size='nan'/>"),
    "endless size": world("<geom size='inf'/>"),
    "endless place": world("<geom size='1' pos='inf 0 0'/>"),
    "NaN place": world("<geom size='1' pos='0 nan 0'/>"),
    "negative mass": world("<body><freejoint/><geom size='1' mass='-1'/></body>"),
    "no mass": world("<body><freejoint/></body>"),
    "NaN density": world("<body><freejoint/><geom size='1' density='nan'/></body>"),
    "NaN turn": world("<geom size='1' quat='nan 0 0 0'/>"),
    "NaN friction": world("<geom size='1' friction='nan 0 0'/>"),
    "a size of words": world("<geom size='big'/>"),
    "negative size": world("<geom type='box' size='-1 1 1'/>"),
    "NaN gravity": model("<option gravity='0 0 nan'/><worldbody><geom size='1'/></worldbody>"),
    "outer include": model("<include file='../other.xml'/>"),
    "absolute include": model("<include file='/etc/passwd'/>"),
    "include of itself": model("<include file='room.xml'/>"),
    "include of a pipe": model("<include file='/dev/stdin'/>"),
    "include of nothing": model("<include file='nowhere.xml'/>"),
    "include without a name": model("<include/>"),
    "include of a zero byte": data(b"<mujoco><include file='a\0b'/></mujoco>"),
    "include by the web": model("<include file='http://localhost/x.xml'/>"),
    "outer mesh": model("<asset><mesh name='m' file='../m.stl'/></asset>"),
    "outer mesh folder": model(
        "<compiler meshdir='..'/><asset><mesh name='m' file='m.stl'/></asset>"
    ),
    "absolute mesh folder": model("<compiler meshdir='/'/><asset><mesh file='m.stl'/></asset>"),
    "outer asset folder": model("<compiler assetdir='/tmp'/><asset><texture type='2d' "
                                "file='t.png'/></asset>"),
    "outer texture": model("<asset><texture name='t' type='2d' file='/etc/passwd'/></asset>"),
    "outer cube side": model("<asset><texture name='t' type='cube' fileup='/etc/passwd'/></asset>"),
    "outer height field": model("<asset><hfield name='h' file='../h.png' size='1 1 1 1'/></asset>"),
    "outer model": model("<asset><model name='m' file='../m.xml'/></asset>"),
    "itself as a model": model("<asset><model name='m' file='room.xml'/></asset>"),
    "missing mesh": model("<asset><mesh name='m' file='m.stl'/></asset>"),
    "mesh of vertices": model("<asset><mesh name='m' vertex='0 0 0 nan 0 0 0 1 0 0 0 1'/></asset>"
                              "<worldbody><geom type='mesh' mesh='m'/></worldbody>"),
    "flat mesh": model("<asset><mesh name='m' vertex='0 0 0 1 0 0 0 1 0'/></asset><worldbody>"
                       "<geom type='mesh' mesh='m'/></worldbody>"),
    "faces of nothing": model("<asset><mesh name='m' vertex='0 0 0 1 0 0 0 1 0 0 0 1' "
                              "face='0 1 99999'/></asset>"),
    "a plugin": model("<extension><plugin plugin='a.b'/></extension>"),
    "a plugin at a body": world("<body><plugin plugin='a.b'/></body>"),
    "a soft body": world("<flexcomp name='f' type='grid' count='900 900 900' spacing='1 1 1'/>"),
    "a composite": world("<composite type='cable' count='9999999 1 1'/>"),
    "a skin": model("<deformable><skin file='/etc/passwd'/></deformable>"),
    "an unknown element": world("<teapot/>"),
    "names twice": world("<geom name='a' size='1'/><geom name='a' size='1'/>"),
    "a class of nothing": world("<geom class='none' size='1'/>"),
    "a joint in the world": world("<freejoint/>"),
}  # fmt: skip

TRIANGLE: Final = struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0)


def stl(count: int, triangles: bytes) -> bytes:
    return bytes(80) + struct.pack("<I", count) + triangles


NAN: Final = float("nan")
MESHES: Final[dict[str, tuple[str, Make]]] = {
    **{f"{name}.stl": ("m.stl", make) for name, make in NO_FILE.items()},
    "too many faces": ("m.stl", data(stl(2**32 - 1, TRIANGLE))),
    "too few faces": ("m.stl", data(stl(100, TRIANGLE * 4))),
    "no faces": ("m.stl", data(stl(0, b""))),
    "half a face": ("m.stl", data(stl(1, TRIANGLE[:20]))),
    "one face": ("m.stl", data(stl(1, TRIANGLE))),
    "a point": ("m.stl", data(stl(50, bytes(50) * 50))),
    "NaN": ("m.stl", data(stl(4, struct.pack("<12fH", *[NAN] * 12, 0) * 4))),
    "infinity": ("m.stl", data(stl(4, struct.pack("<12fH", *[float("inf")] * 12, 0) * 4))),
    "huge": ("m.stl", data(stl(4, struct.pack("<12fH", *[3e38] * 12, 0) * 4))),
    "words": ("m.stl", text("solid x\nfacet normal a b c\nendsolid")),
    "no header": ("m.stl", data(bytes(40))),
    "empty.obj": ("m.obj", text("# nothing\n")),
    "indices of nothing.obj": ("m.obj", text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 999999\n")),
    "negative indices.obj": ("m.obj", text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -99\n")),
    "zero indices.obj": ("m.obj", text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 0 0\n")),
    "huge indices.obj": ("m.obj", text(f"v 0 0 0\nf {2**63} {2**64} {2**70}\n")),
    "NaN.obj": ("m.obj", text("v nan 0 0\nv 1 nan 0\nv 0 1 inf\nv 0 0 1\nf 1 2 3\nf 2 3 4\n")),
    "flat.obj": ("m.obj", text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")),
    "a polygon of thousands.obj": (
        "m.obj",
        text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf " + "1 2 3 " * 30_000 + "\n"),
    ),
    "no faces.obj": ("m.obj", text("v 0 0 0\n" * 10)),
    "a link out.obj": ("m.obj", link("/etc/passwd")),
}


def robot(file: str, old: str, new: str) -> Callable[[Path], None]:
    """A copy of qrio's folder in which a text is another."""

    def make(folder: Path) -> None:
        shutil.copytree(data_folder("models") / "qrio", folder)
        content = (folder / file).read_text(encoding="utf-8")
        assert old in content, old
        (folder / file).write_text(content.replace(old, new, 1), encoding="utf-8")

    return make


def robot_with(file: str, make: Make) -> Callable[[Path], None]:
    """A copy of qrio's folder in which a file is another."""

    def made(folder: Path) -> None:
        shutil.copytree(data_folder("models") / "qrio", folder)
        (folder / file).unlink()
        make(folder / file)

    return made


def crowded(folder: Path) -> None:
    shutil.copytree(data_folder("models") / "qrio", folder)
    for i in range(2100):
        (folder / f"{i}.txt").touch()


MASS: Final = 'mass="2.1"'
XML, TOML = "qrio.xml", "robot.toml"
END: Final = "</worldbody>"
ROBOTS: Final[dict[str, Callable[[Path], None]]] = {
    **{f"{name} as MJCF": robot_with(XML, make) for name, make in NO_FILE.items()},
    **{f"{name} as TOML": robot_with(TOML, make) for name, make in NO_FILE.items()},
    "laughs": robot_with(XML, WORLDS["laughs"]),
    "NaN mass": robot(XML, MASS, 'mass="nan"'),
    "endless mass": robot(XML, MASS, 'mass="inf"'),
    "negative mass": robot(XML, MASS, 'mass="-2.1"'),
    "no mass": robot(XML, MASS, 'mass="0"'),
    "no time step": robot(XML, 'timestep="0.002"', 'timestep="0"'),
    "time that runs back": robot(XML, 'timestep="0.002"', 'timestep="-0.002"'),
    "NaN time step": robot(XML, 'timestep="0.002"', 'timestep="nan"'),
    "nested copies": robot(
        XML,
        END,
        '<replicate count="3000"><replicate count="3000"><site/></replicate></replicate>' + END,
    ),
    "deep": robot(XML, END, "<body>" * 400 + "</body>" * 400 + END),
    "heights": robot(
        XML,
        "<worldbody>",
        '<asset><hfield name="h" nrow="60000" ncol="60000" size="1 1 1 1"/></asset><worldbody>',
    ),
    "memory": robot(XML, "<worldbody>", '<size memory="900G"/><worldbody>'),
    "outer include": robot(XML, "<worldbody>", '<include file="../x.xml"/><worldbody>'),
    "outer mesh": robot(
        XML, "<worldbody>", '<asset><mesh name="m" file="/etc/passwd"/></asset><worldbody>'
    ),
    "a plugin": robot(XML, "<worldbody>", '<extension><plugin plugin="a"/></extension><worldbody>'),
    "endless place": robot(XML, END, '<geom size="1" pos="inf 0 0"/>' + END),
    "model outside": robot(TOML, '"qrio.xml"', '"../qrio.xml"'),
    "model by an absolute path": robot(TOML, '"qrio.xml"', '"/etc/passwd"'),
    "model with a zero byte": robot(TOML, '"qrio.xml"', '"a\\u0000.xml"'),
    "NaN gait": robot(TOML, "[gait]", "[gait]\nx = nan"),
    "endless field of view": robot(TOML, "horizontal_fov = 0.8203", "horizontal_fov = inf"),
    "no field of view": robot(TOML, "horizontal_fov = 0.8203", "horizontal_fov = 0.0"),
    "no period": robot(TOML, "period = 0.08", "period = 0.0"),
    "NaN period": robot(TOML, "period = 0.08", "period = nan"),
    "endless period": robot(TOML, "period = 0.08", "period = inf"),
    "pixels by the million": robot(TOML, "width = 88", "width = 88000000"),
    "too many files": crowded,
}
