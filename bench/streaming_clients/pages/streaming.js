// Shared by the streaming pages: the light and the colours of bench/streaming_pictures.cpp, so that pictures compare.

export const fovy = Math.PI / 3;
export const sky = [0, 0, 1];  // no grey: what is blue alone is not covered

/** GLSL: the luminance of a surface by its normal and the direction to the light, both in the eye's frame. */
export const luminance = 'float luminance(vec3 normal, vec3 light) { return 0.4 + 0.45 * max(0.0, dot(normalize(normal), light)); }';

/** The direction to the light, over the viewer's left shoulder, in the eye's frame: x right, y up, z back. */
export function lightOf({ eye, target }) {
  const [x, y, z] = target.map((t, k) => t - eye[k]);
  const length = Math.hypot(x, y, z), light = [-0.45, 0.7 * Math.hypot(x, y) / length, 0.55 - 0.7 * z / length];
  return light.map((c) => c / Math.hypot(...light));
}

/** What a feature's row of the property table tells. */
export function featureOf(value) {
  const feature = { name: value('name'), layer: value('layer') }, coarsest = value('coarsest_layer');
  if (coarsest !== undefined) feature.coarsest_layer = coarsest;
  return feature;
}

/** CesiumJS: looks from `eye` to `target`, both in `frame`, which leads to the Earth; z is up in it. */
export function placeCamera(widget, frame, { eye, target }) {
  const turned = (v) => Cesium.Cartesian3.normalize(Cesium.Matrix4.multiplyByPointAsVector(frame, v, new Cesium.Cartesian3()), v);
  const direction = turned(new Cesium.Cartesian3(...target.map((t, k) => t - eye[k])));
  const right = Cesium.Cartesian3.cross(direction, turned(new Cesium.Cartesian3(0, 0, 1)), new Cesium.Cartesian3());
  const up = Cesium.Cartesian3.cross(Cesium.Cartesian3.normalize(right, right), direction, new Cesium.Cartesian3());
  const destination = Cesium.Matrix4.multiplyByPoint(frame, new Cesium.Cartesian3(...eye), new Cesium.Cartesian3());
  widget.camera.setView({ destination, orientation: { direction, up } });
  const aspect = widget.canvas.clientWidth / widget.canvas.clientHeight;  // the field of view is that of the longer side
  widget.camera.frustum = new Cesium.PerspectiveFrustum(
    { fov: 2 * Math.atan(Math.tan(fovy / 2) * Math.max(1, aspect)), aspectRatio: aspect, near: 0.5, far: 1e5 });
}
