// Plays a clip in three.js without a screen: play_glb.mjs FILE SECONDS VERTEX prints where one
// vertex of the skin and the first of the lower teeth are then, in metres.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";

const require = createRequire(new URL("../../static/package.json", import.meta.url));
const load = (name) => import(pathToFileURL(require.resolve(name)).href);
const { GLTFLoader } = await load("three/addons/loaders/GLTFLoader.js");
const three = new URL("../../../build/three.module.js", pathToFileURL(require.resolve("three/addons/loaders/GLTFLoader.js")));
const { AnimationMixer, Texture, Vector3 } = await import(three.href);

const [path, seconds, vertex] = process.argv.slice(2);
const file = readFileSync(path);
const buffer = file.buffer.slice(file.byteOffset, file.byteOffset + file.byteLength);
// Pictures are decoded by a browser, and say nothing about where a vertex is.
const loader = new GLTFLoader().register(() => ({
  name: "no pictures",
  loadTexture: () => Promise.resolve(new Texture()),
}));
const gltf = await new Promise((resolve, reject) => loader.parse(buffer, "", resolve, reject));

const report = {};
if (gltf.animations.length > 0) {
  const mixer = new AnimationMixer(gltf.scene);
  mixer.clipAction(gltf.animations[0]).play();
  mixer.setTime(Number(seconds));
  report.animation = gltf.animations[0].name;
}
gltf.scene.updateMatrixWorld(true);
for (const [name, index] of [["skin", Number(vertex)], ["teeth.lower", 0]]) {
  const node = gltf.scene.getObjectByProperty("name", name.replace(".", ""));
  if (node === undefined) continue;
  const mesh = node.isMesh ? node : node.children[0];
  const point = mesh.getVertexPosition(index, new Vector3()).applyMatrix4(mesh.matrixWorld);
  report[name] = point.toArray();
}
console.log(JSON.stringify(report));
