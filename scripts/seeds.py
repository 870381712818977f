"""Small good inputs of every kind that colod reads, made by the program itself: what scripts/mutate changes at random, and what
scripts/fuzz starts from."""
import io
import json
import os
import struct
import subprocess
import zipfile

HOUSE = """o house
v 0 0 0\nv 8 0 0\nv 8 6 0\nv 0 6 0\nv 0 0 5\nv 8 0 5\nv 8 6 5\nv 0 6 5\nv 0 3 7\nv 8 3 7
f 1 4 3 2\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 10 6\nf 4 1 5 9 8\nf 5 6 10 9\nf 7 8 9 10
"""
METADATA = '<?xml version="1.0"?><ModelMetadata version="1"><SRS>EPSG:25832</SRS><SRSOrigin>691000,5334000,500</SRSOrigin></ModelMetadata>'


def make_seeds(colod, folder):
    """Small good inputs of each kind: kind -> list of (path that is changed, arguments, other files)."""
    def run(*arguments):
        subprocess.run([colod, *arguments], cwd=folder, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def read(name):
        with open(os.path.join(folder, name), 'rb') as file:
            return file.read()

    with open(os.path.join(folder, 'house.obj'), 'w', encoding='ascii') as file:
        file.write(HOUSE)
    small = ['--ns', '12', '--nr', '8', '--quiet', '--no-report-html']
    seeds = {kind: [] for kind in ['obj', 'ply', 'off', 'stl', 'gltf', 'glb', 'xyz', 'pwn', 'las', 'b3dm', 'check', 'tileset', 'place', 'scene', 'sidecar',
                                  'options']}
    for compression in ['none', 'draco', 'meshopt']:
        run('build', 'house.obj', '-o', compression, '--compression', compression, '--format', 'glb,3dtiles,ply', *small)
        glb = read(compression + '/buildings/house.glb')
        seeds['check'].append(('x.glb', ['info', '--check', 'x.glb'], glb, {}))
        seeds['glb'].append(('x.glb', ['info', 'x.glb'], glb, {}))
    tiles = {os.path.relpath(os.path.join(d, f), os.path.join(folder, 'none')): read(os.path.relpath(os.path.join(d, f), folder))
             for d, _, files in os.walk(os.path.join(folder, 'none', 'tiles')) for f in files}
    tileset = read('none/tileset.json')
    seeds['tileset'] = [('tileset.json', ['info', '--check', '.'], tileset, tiles), ('tileset.json', ['info', '.'], tileset, {})]
    seeds['obj'] = [('x.obj', ['info', 'x.obj'], HOUSE.encode(), {})]
    points = [[float(x) for x in line.split()[1:]] for line in HOUSE.split('\n') if line.startswith('v ')]
    faces = [[int(x) - 1 for x in line.split()[1:]] for line in HOUSE.split('\n') if line.startswith('f ')]
    off = 'OFF\n%d %d 0\n' % (len(points), len(faces)) + ''.join('%g %g %g\n' % tuple(p) for p in points)
    off += ''.join('%d %s\n' % (len(f), ' '.join(map(str, f))) for f in faces)
    seeds['off'] = [('x.off', ['info', 'x.off'], off.encode(), {})]
    facets = [(f[0], f[i], f[i + 1]) for f in faces for i in range(1, len(f) - 1)]
    stl = 'solid x\n' + ''.join('facet normal 0 0 0\nouter loop\n' + ''.join('vertex %g %g %g\n' % tuple(points[v]) for v in t) +
                                'endloop\nendfacet\n' for t in facets) + 'endsolid x\n'
    binary = b'x'.ljust(80) + struct.pack('<I', len(facets))
    binary += b''.join(struct.pack('<12fH', 0, 0, 0, *[c for v in t for c in points[v]], 0) for t in facets)
    seeds['stl'] = [('x.stl', ['info', 'x.stl'], data, {}) for data in (stl.encode(), binary)]
    ascii_ply = 'ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\n' % len(points)
    ascii_ply += 'element face %d\nproperty list uchar int vertex_indices\nend_header\n' % len(faces) + off.split('\n', 2)[2]
    ply = next(f for f in sorted(os.listdir(os.path.join(folder, 'none/buildings'))) if f.endswith('.ply'))
    seeds['ply'] = [('x.ply', ['info', 'x.ply'], data, {}) for data in (ascii_ply.encode(), read('none/buildings/' + ply))]
    cloud = ''.join('%g %g %g 0 0 1\n' % tuple(p) for p in points)
    seeds['xyz'] = [('x.xyz', ['info', 'x.xyz'], cloud.encode(), {})]
    seeds['pwn'] = [('x.pwn', ['info', 'x.pwn'], ('%d\n' % len(points) + ''.join('%g %g %g\n' % tuple(p) for p in points) +
                                                 '0 0 1\n' * len(points)).encode(), {})]
    header = struct.pack('<4s20xBB68xHII', b'LASF', 1, 2, 227, 227, 0) + struct.pack('<BHI20x', 0, 20, len(points))
    header += struct.pack('<6d6d', 0.01, 0.01, 0.01, 0, 0, 0, 8, 0, 6, 0, 7, 0)
    seeds['las'] = [('x.las', ['info', 'x.las'], header + b''.join(struct.pack('<3iHBBbBH', *[int(100 * c) for c in p], 0, 9, 6, 0, 0, 0)
                                                                   for p in points), {})]
    glb = read('none/buildings/house.glb')
    length = struct.unpack_from('<I', glb, 12)[0]
    document = json.loads(glb[20:20 + length])
    document['buffers'][0]['uri'] = 'x.bin'
    seeds['gltf'] = [('x.gltf', ['info', 'x.gltf'], json.dumps(document).encode(), {'x.bin': glb[28 + length:]})]
    features, batch = b'{"BATCH_LENGTH":0}'.ljust(24), b'{"id":[]}'.ljust(16)
    b3dm = struct.pack('<4s6I', b'b3dm', 1, 28 + 40 + len(glb), len(features), 0, len(batch), 0) + features + batch + glb
    seeds['b3dm'] = [('x.b3dm', ['info', 'x.b3dm'], b3dm, {})]
    region = {'box': [4, 3, 3, 6, 0, 0, 0, 6, 0, 0, 0, 6]}
    leaf = {'boundingVolume': region, 'geometricError': 0, 'content': {'uri': 'x.b3dm'}}
    root = {'boundingVolume': region, 'geometricError': 5, 'refine': 'REPLACE', 'children': [leaf], 'transform': [
        1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}
    place = json.dumps({'asset': {'version': '1.0', 'gltfUpAxis': 'Y'}, 'geometricError': 50, 'root': root}).encode()
    ring = [[-1, -1], [9, -1], [9, 7], [-1, 7], [-1, -1]]
    plan = json.dumps({'type': 'FeatureCollection', 'features': [
        {'type': 'Feature', 'properties': {'id': 'a'}, 'geometry': {'type': 'Polygon', 'coordinates': [ring]}}]}).encode()
    whole = {'tileset.json': place, 'x.b3dm': b3dm, 'plan.geojson': plan}
    read_place = ['build', 'tileset.json', '-o', 'out', '--scene', 'scene', '--footprints', 'plan.geojson', *small]
    seeds['place'] = [(name, read_place, data, {n: d for n, d in whole.items() if n != name}) for name, data in whole.items()]
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, 'w', zipfile.ZIP_DEFLATED) as packed:
        for name in ['tileset.json', 'x.b3dm']:
            packed.writestr(zipfile.ZipInfo(name), whole[name], zipfile.ZIP_DEFLATED)
    seeds['place'].append(('x.3tz', ['x.3tz' if word == 'tileset.json' else word for word in read_place], archive.getvalue(), {'plan.geojson': plan}))
    run('segment', 'house.obj', '-o', 'house.colod', '--ns', '12', '--nr', '8', '--quiet')
    run('analyze', 'house.colod')
    run('mesh', 'house.colod', '--quiet')
    export = ['export', 'x.colod', '-o', 'out', '--no-report-html', '--quiet']
    seeds['scene'] = [('x.colod', export, read('house.colod'), {})]
    seeds['sidecar'] = [('metadata.xml', ['build', 'house.obj', '-o', 'out', *small], METADATA.encode(), {'house.obj': HOUSE.encode()})]
    seeds['options'] = [('house.obj', ['build', 'house.obj', '-o', 'out', *small], HOUSE.encode(), {})]
    return seeds
