/** The stage: camera, light, floor, and the character's scene. */

import {
  Box3, CanvasTexture, CircleGeometry, Color, DirectionalLight, HemisphereLight, Mesh, MeshBasicMaterial, PCFSoftShadowMap, PerspectiveCamera, Plane,
  PlaneGeometry, Raycaster, Scene, ShadowMaterial, SkeletonHelper, SRGBColorSpace, Vector2, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";

// As the desktop's preview sees a person of 1.7 m: three quarters from the front, a long lens.
const FOV = 28, YAW = (28 * Math.PI) / 180, PITCH = (7 * Math.PI) / 180, DISTANCE = 4.2, TARGET = new Vector3(0, 0.9, 0);

export class Stage {
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(2, devicePixelRatio));
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFSoftShadowMap;
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(FOV, 1, 0.05, 100);
    this.controls = new OrbitControls(this.camera, canvas);
    this.pointer = null;
    this.ray = new Raycaster();
    canvas.addEventListener("pointermove", (event) => {
      const box = canvas.getBoundingClientRect();
      this.pointer = new Vector2(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2);
    });
    canvas.addEventListener("pointerleave", () => (this.pointer = null));
    this.light();
    const scheme = matchMedia("(prefers-color-scheme: light)");
    scheme.addEventListener("change", () => this.paint());
    this.paint();
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.view();
    this.resize();
  }

  light() {
    this.scene.add(new HemisphereLight(0xffffff, 0x8a8f98, 1.6));
    const sun = new DirectionalLight(0xffffff, 2.2);
    sun.position.set(1.6, 3.4, 2.6);
    sun.castShadow = true;
    sun.shadow.mapSize.set(1024, 1024);
    Object.assign(sun.shadow.camera, { left: -1.5, right: 1.5, top: 2.2, bottom: -1.2 });
    sun.shadow.radius = 6;
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
    this.scene.add(this.floor, shade);
  }

  /** Take the page's colours. */
  paint() {
    const look = getComputedStyle(document.documentElement);
    this.scene.background = new Color(look.getPropertyValue("--ground").trim());
    this.floor.material.color.set(look.getPropertyValue("--floor").trim());
    const line = new Color(look.getPropertyValue("--dim").trim());
    this.bones?.setColors(line, line);
  }

  view(target = TARGET, scale = 1) {
    const flat = Math.cos(PITCH) * DISTANCE * scale;
    this.camera.position.set(target.x + Math.sin(YAW) * flat, target.y + Math.sin(PITCH) * DISTANCE * scale, target.z + Math.cos(YAW) * flat);
    this.controls.target.copy(target);
    this.controls.update();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width || !height) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
  }

  /** Add the export's GLB; return its scene. @param {ArrayBuffer} bytes */
  async add(bytes) {
    const { scene } = await new GLTFLoader().parseAsync(bytes.slice(0), "");
    let drawn = false;
    scene.traverse((object) => {
      if (!object.isMesh) return;
      drawn = object.castShadow = object.receiveShadow = true;
      object.frustumCulled = false; // its bounds are those of the rest pose
    });
    this.scene.add(scene);
    if (!drawn) {
      scene.traverse((object) => (object.isBone = object.isBone || (!object.isMesh && object !== scene)));
      this.bones = new SkeletonHelper(scene);
      this.scene.add(this.bones);
      this.paint();
    }
    const bounds = new Box3().setFromObject(scene);
    const height = bounds.max.y - bounds.min.y;
    if (drawn && height > 0.1 && (height < 1.2 || height > 2.4)) this.view(bounds.getCenter(new Vector3()), height / 1.75);
    return scene;
  }

  /** Let the character look at the pointer, where that was asked for. */
  follow(object, panel) {
    if (!panel.following || !this.pointer) return;
    this.ray.setFromCamera(this.pointer, this.camera);
    const ahead = new Plane().setFromNormalAndCoplanarPoint(this.camera.getWorldDirection(new Vector3()), new Vector3(0, 1.4, 0).lerp(this.camera.position, 0.45));
    const point = this.ray.ray.intersectPlane(ahead, new Vector3());
    const now = object.character.now;
    if (!point || (this.placed && now - this.placed < 0.1)) return; // ten times a second is enough for eyes
    this.placed = now;
    object.ask({ do: "place", id: "pointer", name: "pointer", point: point.toArray() });
  }

  draw() {
    this.controls.update();
    this.renderer.render(this.scene, this.camera);
  }
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
