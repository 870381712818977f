// Streaming: a tileset of colod's, laid at three.js' origin with y up, wherever on Earth it stands.
import { Box3, Matrix4, Quaternion, Vector3 } from 'three';
import { DRACOLoader } from 'three/addons/loaders/DRACOLoader.js';
import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js';
import { TilesRenderer } from '3d-tiles-renderer/three';
import { GLTFExtensionsPlugin } from '3d-tiles-renderer/three/plugins';

/**
 * Calls `placed(box, extras)` when the tileset is there: its box (m, y up, the middle of the ground at the origin) and its
 * asset's extras. The caller calls update() every frame.
 */
export function openTileset(url, camera, renderer, placed) {
  const tiles = new TilesRenderer(url);
  tiles.registerPlugin(new GLTFExtensionsPlugin({ metadata: true, meshoptDecoder: MeshoptDecoder,
    dracoLoader: new DRACOLoader().setDecoderPath('draco/') }));
  tiles.setCamera(camera);
  tiles.setResolutionFromRenderer(camera, renderer);
  tiles.addEventListener('load-root-tileset', ({ tileset }) => placed(lay(tiles), tileset.asset.extras ?? {}));
  return tiles;
}

/**
 * Turns and moves the tileset, in doubles, so that the root's frame (on Earth: about east, north and up at its place) takes
 * three.js' axes and what is drawn stays near the origin.
 */
function lay({ root, group }) {
  const frame = root.engineData.transform;
  const box = new Box3(), axes = new Matrix4();
  root.engineData.boundingVolume.getOBB(box, axes);
  box.applyMatrix4(axes.premultiply(frame.clone().invert()));
  const middle = box.getCenter(new Vector3()).setZ(box.min.z);
  const upright = new Quaternion().setFromAxisAngle(new Vector3(1, 0, 0), -Math.PI / 2);
  const turned = new Quaternion().setFromRotationMatrix(new Matrix4().extractRotation(frame));
  group.quaternion.copy(upright).multiply(turned.invert());
  group.position.copy(middle).applyMatrix4(frame).applyQuaternion(group.quaternion).negate();
  return box.translate(middle.negate()).applyMatrix4(new Matrix4().makeRotationFromQuaternion(upright));
}

/** Rows of the property table (EXT_structural_metadata) by the feature ids of a mesh; none for a foreign one. */
export function rowsOf(mesh) {
  const { meshFeatures, structuralMetadata } = mesh.userData;
  if (!meshFeatures || !structuralMetadata) return [];
  const { featureCount, propertyTable } = meshFeatures.getFeatureInfo()[0];
  return Array.from({ length: featureCount }, (_, id) => structuralMetadata.getPropertyTableData([propertyTable], [id])[0]);
}

/** The attribute of a mesh that holds a feature id per vertex. */
export function idsOf(mesh) {
  return mesh.geometry.getAttribute('_feature_id_0');
}
