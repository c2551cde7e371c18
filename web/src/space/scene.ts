// The WebGL view, on three.js. A bundle of its own: it is run only for a report with a space model.
import { DirectionalLight, HemisphereLight, MOUSE, OrthographicCamera, Scene, TOUCH, Vector3, WebGLRenderer } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { fit_to, fitted, type Direction, type Frame } from "./frame";
import type { Look } from "./layers";
import { scene_items, type Item } from "./scene_items";
import { Box3, point, type Vec3 } from "./vector";
import type { MakeScene, View, ViewInput } from "./view";

const TURN = Math.PI / 36;
const SHIFT = 24;
// What the controls call a scale: below one comes closer.
const CLOSER = 1 / 1.15;

class SceneView implements View {
  readonly canvas: HTMLCanvasElement;
  readonly free = true;
  private readonly input_: ViewInput;
  private readonly renderer_: WebGLRenderer;
  private readonly scene_ = new Scene();
  private readonly camera_ = new OrthographicCamera();
  private readonly sun_ = new DirectionalLight(0xffffff, 2.1);
  private readonly controls_: OrbitControls;
  private readonly items_: Item[];
  private readonly depth_: number;
  private width_ = 1;
  private height_ = 1;
  /** Metres that the picture shows at least, without the reader's zoom. */
  private seen_ = { width: 1, height: 1 };
  private look_: Look | null = null;

  constructor(input: ViewInput, canvas: HTMLCanvasElement, context: WebGL2RenderingContext) {
    this.input_ = input;
    this.canvas = canvas;
    this.renderer_ = new WebGLRenderer({ canvas, context, antialias: true, alpha: true });
    this.renderer_.setClearColor(0x000000, 0);
    this.items_ = scene_items(input);
    this.scene_.add(this.camera_, new HemisphereLight(0xffffff, 0xb9c0c8, 1.5), ...this.items_.map((item) => item.object));
    // The light comes over the viewer's left shoulder, so that the sides of a box differ from every direction.
    this.camera_.add(this.sun_, this.sun_.target);
    this.sun_.position.set(-0.55, 0.8, 0.6);
    this.sun_.target.position.set(0, 0, 0);
    const box = new Box3();
    for (let i = 0; 3 * i < input.space.nodes.length; i++) box.include(point(input.space.nodes, i));
    this.depth_ = 10 * (box.size || 1);
    this.camera_.up.set(0, 0, 1);
    this.camera_.near = 0;
    this.camera_.far = 2 * this.depth_;
    this.controls_ = this.make_controls();
  }

  get frame(): Frame {
    const [right, up, out] = [new Vector3(), new Vector3(), new Vector3()];
    this.camera_.matrixWorld.extractBasis(right, up, out);
    const scale = (this.height_ * this.camera_.zoom) / (this.camera_.top - this.camera_.bottom);
    return { right: right.toArray(), up: up.toArray(), out: out.toArray(), centre: this.controls_.target.toArray(), scale, width: this.width_, height: this.height_ };
  }

  resize(width: number, height: number, density: number): void {
    this.width_ = width;
    this.height_ = height;
    this.renderer_.setPixelRatio(density);
    this.renderer_.setSize(width, height, false);
    this.fit_camera();
  }

  aim(from: Direction | null, box: Box3): void {
    const frame = from ? fitted(from, box, this.width_, this.height_) : fit_to(this.frame, box);
    this.camera_.zoom = 1;
    this.seen_ = { width: this.width_ / frame.scale, height: this.height_ / frame.scale };
    this.fit_camera();
    this.look_from(frame.centre, frame.out);
  }

  draw(look: Look): void {
    this.look_ = look;
    for (const item of this.items_) {
      item.object.visible = look.shown(item.key);
      if (item.object.visible) item.update(this.input_.pose, look);
    }
    this.render();
  }

  dispose(): void {
    this.controls_.dispose();
    this.renderer_.dispose();
  }

  // Whatever the shape of the picture becomes, it shows what was last aimed at.
  private fit_camera(): void {
    const aspect = this.width_ / this.height_;
    const half = Math.max(this.seen_.height, this.seen_.width / aspect) / 2;
    Object.assign(this.camera_, { top: half, bottom: -half, left: -half * aspect, right: half * aspect });
    this.camera_.updateProjectionMatrix();
  }

  private look_from(centre: Vec3, out: Vec3): void {
    this.controls_.target.set(...centre);
    // Straight from above the upward direction would be lost: a trace of −y keeps y upwards in the picture.
    const tilt = Math.abs(out[2]) > 0.9999 ? -1e-5 : 0;
    this.camera_.position.set(centre[0] + this.depth_ * out[0], centre[1] + this.depth_ * (out[1] + tilt), centre[2] + this.depth_ * out[2]);
    this.controls_.update();
    this.camera_.updateMatrixWorld();
  }

  // Only what the last draw() showed: turning the view moves no vertex.
  private render(): void {
    this.camera_.updateMatrixWorld();
    if (this.look_) this.renderer_.render(this.scene_, this.camera_);
  }

  private make_controls(): OrbitControls {
    const controls = new OrbitControls(this.camera_, this.canvas);
    controls.enableDamping = false;
    controls.zoomToCursor = true;
    controls.mouseButtons = { LEFT: MOUSE.ROTATE, MIDDLE: MOUSE.DOLLY, RIGHT: MOUSE.PAN };
    controls.touches = { ONE: TOUCH.ROTATE, TWO: TOUCH.DOLLY_PAN };
    // A finger that moves up or down scrolls the page; sideways it turns the model.
    this.canvas.style.touchAction = "pan-y";
    controls.addEventListener("change", () => {
      this.render();
      this.input_.on_move();
    });
    this.canvas.addEventListener("pointerdown", () => this.canvas.focus({ preventScroll: true }));
    this.canvas.addEventListener("keydown", (event) => this.on_key(event));
    return controls;
  }

  private on_key(event: KeyboardEvent): void {
    const controls = this.controls_;
    const turn: Record<string, () => void> = {
      ArrowLeft: () => (event.shiftKey ? controls.pan(SHIFT, 0) : controls.rotateLeft(TURN)),
      ArrowRight: () => (event.shiftKey ? controls.pan(-SHIFT, 0) : controls.rotateLeft(-TURN)),
      ArrowUp: () => (event.shiftKey ? controls.pan(0, SHIFT) : controls.rotateUp(TURN)),
      ArrowDown: () => (event.shiftKey ? controls.pan(0, -SHIFT) : controls.rotateUp(-TURN)),
      "+": () => controls.dollyIn(CLOSER),
      "-": () => controls.dollyOut(CLOSER),
    };
    const act = turn[event.key];
    if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    act();
    controls.update();
  }
}

export const make_scene: MakeScene = (input, canvas, context) => new SceneView(input, canvas, context);
