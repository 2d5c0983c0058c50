"""Prints, as JSON, how far the vertices of one file are from the mesh of another, by MeshLab's filter."""

import json
import sys

import pymeshlab

meshes = pymeshlab.MeshSet()
for path in sys.argv[1:3]:
    meshes.load_new_mesh(path)
print(json.dumps(meshes.apply_filter(
    "get_hausdorff_distance", sampledmesh=0, targetmesh=1, samplevert=True, sampleedge=False, samplefauxedge=False,
    sampleface=False, samplenum=meshes.mesh(0).vertex_number(), maxdist=pymeshlab.PercentageValue(100))))
