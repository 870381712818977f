// Packages as modules, without a bundler.
const map = document.createElement('script');
map.type = 'importmap';
map.textContent = JSON.stringify({ imports: {
  three: '/node_modules/three/build/three.module.js',
  'three/addons/': '/node_modules/three/examples/jsm/',
  '3d-tiles-renderer': '/node_modules/3d-tiles-renderer/build/index.three.js',
  '3d-tiles-renderer/plugins': '/node_modules/3d-tiles-renderer/build/index.three-plugins.js' } });
document.currentScript.after(map);
