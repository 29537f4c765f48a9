"""Ends without an error where ParaView has its Python module: pvbatch find_paraview.py"""
from paraview.simple import GetParaViewVersion

print(GetParaViewVersion())
