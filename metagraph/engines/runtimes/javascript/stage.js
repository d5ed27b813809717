/** A stage for one character in three.js: camera, light, a soft floor, and the character's scene. */

import {
  Box3, CanvasTexture, CircleGeometry, Color, DirectionalLight, HemisphereLight, Mesh, MeshBasicMaterial, PCFShadowMap, PerspectiveCamera, Plane,
  PlaneGeometry, Raycaster, Scene, ShadowMaterial, SkeletonHelper, SRGBColorSpace, Vector2, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { MeshoptDecoder } from "./meshopt.js";

const FOV = 28, PITCH = 7, DISTANCE = 4.2, HEIGHT = 1.75; // degrees, metres: as the desktop's preview sees somebody of that height, a long lens
const SIDES = { front: 0, "three-quarter": 28, left: 90, right: -90, back: 180 }; // degrees
// Of the height: how much is in the picture, and where its middle is when the character has no head to look at.
const PARTS = { body: [1, 0.9 / HEIGHT], upper: [0.5, 0.78], face: [0.23, 0.92] };

export class Stage {
  /** @param {HTMLCanvasElement} canvas @param {boolean} [turning] whether dragging turns the camera and the wheel moves it */
  constructor(canvas, turning = false) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(2, devicePixelRatio));
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(FOV, 1, 0.05, 100);
    this.target = new Vector3(0, 0.9, 0);
    this.bounds = null;
    this.head = null;
    this.own = null; // bounds and head of what was added
    this.worn = null; // another look's scene
    this.framed = "";
    this.pointer = null;
    this.ray = new Raycaster();
    canvas.addEventListener("pointermove", (event) => {
      const box = canvas.getBoundingClientRect();
      this.pointer = new Vector2(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2);
    });
    canvas.addEventListener("pointerleave", () => (this.pointer = null));
    this.light();
    this.controls = null;
    this.turning(turning);
    this.sizes = new ResizeObserver(() => this.resize());
    this.sizes.observe(canvas);
    this.view("body");
    this.filled = false; // whether there is somebody to draw
    this.resize();
  }

  /** @param {boolean} on */
  turning(on) {
    if (on === Boolean(this.controls)) return;
    this.controls?.dispose();
    this.controls = on ? new OrbitControls(this.camera, this.canvas) : null;
    this.controls?.target.copy(this.target);
  }

  light() {
    this.scene.add(new HemisphereLight(0xffffff, 0x8a8f98, 1.6));
    const sun = new DirectionalLight(0xffffff, 2.2);
    sun.position.set(1.6, 3.4, 2.6);
    sun.castShadow = true;
    sun.shadow.mapSize.set(1024, 1024);
    Object.assign(sun.shadow.camera, { left: -1.5, right: 1.5, top: 2.2, bottom: -1.2 });
    sun.shadow.radius = 4;
    sun.shadow.normalBias = 0.02; // a face must not speckle its own cheeks
    this.scene.add(sun);
    const rim = new DirectionalLight(0xffffff, 0.9);
    rim.position.set(-2, 2, -3);
    this.scene.add(rim);
    const shade = new Mesh(new PlaneGeometry(12, 12), new ShadowMaterial({ opacity: 0.28 }));
    shade.rotation.x = -Math.PI / 2;
    shade.receiveShadow = true;
    this.floor = new Mesh(new CircleGeometry(2.4, 64), new MeshBasicMaterial({ transparent: true, depthWrite: false, map: fading() }));
    this.floor.rotation.x = -Math.PI / 2;
    this.floor.position.y = -0.001;
    this.floor.visible = false;
    this.scene.add(this.floor, shade);
  }

  /**
   * @param {string | null} ground what is behind the character, a colour; null to see the page through
   * @param {string | null} [floor] colour of the middle of the floor; null for its shadow alone @param {string} [bones] of a character without a mesh
   */
  paint(ground, floor = null, bones = "#888") {
    this.scene.background = ground ? new Color(ground) : null;
    this.floor.visible = Boolean(floor);
    if (floor) this.floor.material.color.set(floor);
    const line = new Color(bones);
    this.bones?.setColors(line, line);
  }

  /**
   * Look at a part of the character from a side. Words that are neither change nothing.
   * @param {string} words such as "face", "upper front", "body left"
   */
  view(words) {
    this.framed = words;
    const named = words.split(/\s+/);
    const [share, middle] = PARTS[named.find((word) => word in PARTS) ?? "body"];
    const yaw = ((SIDES[named.find((word) => word in SIDES) ?? "three-quarter"]) * Math.PI) / 180, pitch = (PITCH * Math.PI) / 180;
    const bounds = this.bounds;
    let height = bounds ? bounds.max.y - bounds.min.y : HEIGHT;
    this.target.set(0, middle * HEIGHT, 0);
    if (share < 0.9 || height < 1.2 || height > 2.4) bounds?.getCenter(this.target).setY(bounds.min.y + middle * height);
    else height = HEIGHT; // a person's: as the preview
    if (share < 0.9 && this.head) {
      this.head.getWorldPosition(this.target);
      this.target.y += (share < 0.3 ? 0.035 : -0.14) * height;
    }
    // A narrow picture is filled by the width, in which there are arms.
    const wide = Math.min(1, this.camera.aspect / (share < 0.3 ? 0.75 : 0.5));
    const distance = (DISTANCE * share * (height / HEIGHT)) / wide, flat = Math.cos(pitch) * distance;
    this.camera.position.set(this.target.x + Math.sin(yaw) * flat, this.target.y + Math.sin(pitch) * distance, this.target.z + Math.cos(yaw) * flat);
    this.camera.lookAt(this.target);
    this.controls?.target.copy(this.target);
    this.controls?.update();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width || !height) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (!this.controls) this.view(this.framed);
    if (this.filled) this.draw();
  }

  /** Add a GLB; return its scene. @param {ArrayBuffer} bytes @param {string} [head] name of the head's node */
  async add(bytes, head = "") {
    const { scene } = await readGlb(bytes);
    let drawn = false;
    const meshes = new Map(); // by what their vertices are: parts of different materials share them
    scene.traverse((object) => {
      if ((object.userData.name ?? object.name) === head) this.head = object;
      if (!object.isMesh) return;
      drawn = true;
      castShadows(object);
      meshes.set(object.geometry.attributes.position, object);
    });
    this.scene.add(scene);
    if (!drawn) {
      scene.traverse((object) => (object.isBone = object.isBone || (!object.isMesh && object !== scene)));
      this.bones = new SkeletonHelper(scene);
      this.scene.add(this.bones);
    }
    scene.updateMatrixWorld();
    const bounds = new Box3();
    for (const mesh of meshes.values()) bounds.union(new Box3().setFromBufferAttribute(mesh.geometry.attributes.position).applyMatrix4(mesh.matrixWorld));
    this.filled = true;
    if (drawn && bounds.max.y - bounds.min.y > 0.1) this.bounds = bounds;
    this.own = { bounds: this.bounds, head: this.head };
    this.view(this.framed);
    return scene;
  }

  /** Show another look in place of what was added, null for that, and give back the one before. @param {import("./avatar.js").Avatar | null} avatar */
  wear(avatar) {
    if (this.worn) {
      this.scene.remove(this.worn);
      release(this.worn);
    }
    this.worn = avatar?.scene ?? null;
    if (this.bones) this.bones.visible = !avatar;
    Object.assign(this, this.own);
    if (avatar) {
      avatar.scene.traverse((object) => object.isMesh && castShadows(object));
      this.scene.add(avatar.scene);
      this.head = avatar.head;
      avatar.scene.updateMatrixWorld(true);
      const bounds = new Box3().setFromObject(avatar.scene, true); // as it stands at rest
      if (bounds.max.y - bounds.min.y > 0.1) this.bounds = bounds;
    }
    if (!this.controls) this.view(this.framed);
  }

  /** Return the point the pointer is at, a way ahead of the character; null where it is elsewhere. @returns {number[] | null} */
  pointed() {
    if (!this.pointer) return null;
    this.ray.setFromCamera(this.pointer, this.camera);
    const between = new Vector3(0, 1.4, 0).lerp(this.camera.position, 0.45);
    const ahead = new Plane().setFromNormalAndCoplanarPoint(this.camera.getWorldDirection(new Vector3()), between);
    return this.ray.ray.intersectPlane(ahead, new Vector3())?.toArray() ?? null;
  }

  /** Begin to make the programs that draw what is there, without waiting for them. */
  compile() {
    this.renderer.compile(this.scene, this.camera);
  }

  draw() {
    this.controls?.update();
    this.renderer.render(this.scene, this.camera);
  }

  /** Give back what the graphics card holds. */
  dispose() {
    this.sizes.disconnect();
    this.controls?.dispose();
    release(this.scene);
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }
}

/**
 * Read a GLB, or a glTF. @param {ArrayBuffer} bytes @param {string} [folder] address of what lies beside it
 * @returns {Promise<{scene: import("three").Group, parser: object}>}
 */
export function readGlb(bytes, folder = "") {
  const loader = new GLTFLoader();
  loader.register(unanimated);
  loader.setMeshoptDecoder(MeshoptDecoder);
  return loader.parseAsync(bytes, folder);
}

function castShadows(mesh) {
  mesh.castShadow = mesh.receiveShadow = true;
  mesh.frustumCulled = false; // its bounds are those of the rest pose
}

/** Give back what the graphics card holds of objects. */
function release(objects) {
  objects.traverse((object) => {
    object.geometry?.dispose();
    for (const material of [object.material ?? []].flat()) {
      for (const value of Object.values(material)) if (value?.isTexture) value.dispose();
      material.dispose();
    }
    object.skeleton?.dispose();
  });
}

/** Leave out the animations of a GLB, which the character plays by itself: thousands of tracks that take long to make. */
function unanimated(parser) {
  delete parser.json.animations;
  return { name: "METAGRAPH_unanimated" };
}

/** Return a texture that fades out from its middle, so that the floor has no edge. */
function fading() {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 256;
  const paint = canvas.getContext("2d");
  const gradient = paint.createRadialGradient(128, 128, 10, 128, 128, 128);
  gradient.addColorStop(0, "rgba(255,255,255,1)");
  gradient.addColorStop(1, "rgba(255,255,255,0)");
  paint.fillStyle = gradient;
  paint.fillRect(0, 0, 256, 256);
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = SRGBColorSpace;
  return texture;
}
