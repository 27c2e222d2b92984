// Plays a clip in three.js without a screen: play_frames.mjs FILE SECONDS… prints, for each time, a
// line with where every eleventh vertex of each mesh that has morph targets is then, in metres.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";

const STRIDE = 11;
const require = createRequire(new URL("../../static/package.json", import.meta.url));
const load = (name) => import(pathToFileURL(require.resolve(name)).href);
const loaders = require.resolve("three/addons/loaders/GLTFLoader.js");
const { GLTFLoader } = await load("three/addons/loaders/GLTFLoader.js");
const three = new URL("../../../build/three.module.js", pathToFileURL(loaders));
const { AnimationMixer, Texture, Vector3 } = await import(three.href);

const [path, ...times] = process.argv.slice(2);
const file = readFileSync(path);
const buffer = file.buffer.slice(file.byteOffset, file.byteOffset + file.byteLength);
// Pictures are decoded by a browser, and say nothing about where a vertex is.
const loader = new GLTFLoader().register(() => ({
  name: "no pictures",
  loadTexture: () => Promise.resolve(new Texture()),
}));
const gltf = await new Promise((resolve, reject) => loader.parse(buffer, "", resolve, reject));
const clip = gltf.animations[0];
const mixer = new AnimationMixer(gltf.scene);
mixer.clipAction(clip).play();

for (const time of times) {
  mixer.setTime(Number(time));
  gltf.scene.updateMatrixWorld(true);
  const meshes = {};
  gltf.scene.traverse((mesh) => {
    if (!mesh.isMesh) return;
    const points = [];
    for (let index = 0; index < mesh.geometry.attributes.position.count; index += STRIDE) {
      const point = mesh.getVertexPosition(index, new Vector3()).applyMatrix4(mesh.matrixWorld);
      points.push(point.toArray());
    }
    meshes[mesh.name] = points;
  });
  console.log(JSON.stringify({ name: clip.name, duration: clip.duration, meshes }));
}
