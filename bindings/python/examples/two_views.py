# SPDX-License-Identifier: BSD-2-Clause
"""Two views of a room: junctions, matches, line segments and the camera's motion, step by step. Writes the pictures of README.md into
the folder given (default: where you are): two_views.py [FOLDER]   (needs asj[images,plot])
"""

# %% Two pictures of a rendered room. Any arrays of HxW or HxWx3 do; asj.read_image("photo.jpg") reads files.
import sys
from pathlib import Path

import asj
import matplotlib
import numpy as np
import room

matplotlib.use("Agg")
folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path()
things, cameras = room.make(seed=2), room.walk(7)
image1, image2 = room.render(things, cameras[1], seed=1), room.render(things, cameras[4], seed=4)

# %% Junctions: where they are, the segments of their branches, how sure they are.
features1, features2 = asj.detect(image1), asj.detect(image2)
print(features1, features2)
print("the surest junction:", features1.xy[0].round(2), "log10 NFA", features1.log10_nfa[0].round(1))
shown = asj.detect(image1, preset="default")  # to look at: only those that no noise can have made
asj.plot(image1, shown).figure.savefig(folder / "junctions.png", bbox_inches="tight", pad_inches=0)

# %% Matches: index pairs, places in both images, an affine map each.
matches = asj.match(features1, features2)
print(matches, matches.indices[:3].tolist())
asj.plot_matches(image1, image2, matches).figure.savefig(folder / "matches.png", bbox_inches="tight", pad_inches=0)

# %% Line segments that correspond from end to end.
segments1, segments2, which = matches.segments("both")
print(len(segments1), "line segments")

# %% The camera's motion, from the same matches and the focal length; and how far it is from the truth.
posed = asj.match(features1, features2, geometry="essential", camera1=cameras[1].focal)
geometry = posed.geometry
assert geometry and geometry.rotation is not None and geometry.translation is not None
truth = cameras[4].rotation @ cameras[1].rotation.T
turned = np.degrees(np.arccos(np.clip((np.trace(geometry.rotation @ truth.T) - 1) / 2, -1, 1)))
step = cameras[4].rotation @ (cameras[1].position - cameras[4].position)
aside = np.degrees(np.arccos(geometry.translation @ step / np.linalg.norm(step)))
print(f"{geometry.model}: rotation {turned:.2f} degrees from the truth, translation {aside:.2f}; {(posed.probability > 0.5).sum()} sure matches")

# %% Many pairs: features of an image are described once, and can be kept in files.
features1.save(folder / "room1.asjf")
assert len(asj.match(asj.load_features(folder / "room1.asjf"), features2)) == len(matches)
(folder / "room1.asjf").unlink()
