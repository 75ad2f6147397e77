"""Prints what VTK reads in a .vtp file, as JSON: python3 read_vtp.py FILE"""

import collections
import json
import sys

from vtkmodules.vtkIOXML import vtkXMLPolyDataReader


def main(file):
    reader = vtkXMLPolyDataReader()
    errors = []
    reader.AddObserver("ErrorEvent", lambda *event: errors.append(event))
    reader.AddObserver("WarningEvent", lambda *event: errors.append(event))
    reader.SetFileName(file)
    reader.Update()
    if errors or reader.GetErrorCode():
        sys.exit(f"VTK complains of {file}")
    data = reader.GetOutput()
    point_data, cell_data, field_data = data.GetPointData(), data.GetCellData(), data.GetFieldData()
    fields = [field_data.GetAbstractArray(i) for i in range(field_data.GetNumberOfArrays())]
    force, kind = point_data.GetArray("force_N"), cell_data.GetArray("kind")
    forces = [force.GetTuple3(i) for i in range(data.GetNumberOfPoints())]
    print(json.dumps({
        "points": data.GetNumberOfPoints(),
        "vertices": data.GetNumberOfVerts(),
        "lines": data.GetNumberOfLines(),
        "polygons": data.GetNumberOfPolys(),
        "bounds": data.GetBounds(),
        "vectors": point_data.GetVectors().GetName(),
        "normals": point_data.GetNormals().GetName(),
        "fields": {field.GetName(): [field.GetValue(k) for k in range(field.GetNumberOfValues())] for field in fields},
        "force": [sum(row[k] for row in forces) for k in range(3)],
        "kinds": collections.Counter(str(int(kind.GetTuple1(c))) for c in range(data.GetNumberOfCells())),
    }))


if __name__ == "__main__":
    main(*sys.argv[1:])
