import GUI from "lil-gui";
import type { Controller, OptionController } from "lil-gui";
import type { Diagnostics, Dial as DialMessage, Settings, Welcome } from "../gen/spherule/v1/control_pb";
import { modeFor, modeList, modeNames } from "../colour/modes";
import type { Mode } from "../colour/modes";
import type { Commands } from "../connection/commands";
import type { View } from "../connection/messages";
import type { QualityChoice } from "../renderer/quality";
import type { ThemeName } from "../renderer/theme";
import type { Facts } from "../scene/facts";
import { dropFor, impulseFor, impulseNote } from "./amounts";
import { goalFrom, goalNames, goals, heldBy } from "./auto";
import type { GoalName } from "./auto";
import { Dial } from "./dial";
import { presetOf, presets } from "./gravity";
import { Restriction } from "./restriction";
import { StatisticsTables } from "./statistics";
import { StreamFolder } from "./stream";
import { tag } from "./tag";

/** What the panel holds that only the page uses. */
export interface Choices {
  mode: Mode;
  modeChosen: boolean; // false: the scene decides
  quality: QualityChoice;
  theme: ThemeName;
  push: boolean;
  impulse: number; // N s
  view: View;
}

export interface PanelActions {
  themed(theme: ThemeName): void;
  qualityChosen(quality: QualityChoice): void;
  viewWished(view: View): void;
  forgetToken(): void;
}

/** The controls at the side. Commands go out when a control is let go; what the server settled on comes back. */
export class Panel {
  readonly element: HTMLElement;
  private readonly gui: GUI;
  readonly stream: StreamFolder;
  private readonly statistics = new StatisticsTables();
  private readonly world = {
    scene: "",
    gravity: "Earth",
    x: 0,
    y: 0,
    z: 0,
    restitution: 0.5,
    friction: 0,
    speed: 1,
    auto: "off" as GoalName,
    goal: 0, // in the unit of what is held
  };
  private readonly steering: GUI[] = []; // folders with which the world is changed
  private readonly simulated: GUI[] = []; // folders that are of no use in a recording
  private playback!: GUI;
  private readonly access: GUI; // of no use where there is no token
  private readonly restriction: Restriction;
  private readonly drop = { count: 200, radius: 0.05 };
  private readonly scene: OptionController;
  private readonly dial = new Dial(({ model, substeps, own }) => void this.change("Quality", own ? { model } : { model, substeps }));
  private goal!: Controller;
  private facts: Facts | undefined;
  private settled: Settings | undefined;

  constructor(
    private readonly commands: Commands,
    readonly choices: Choices,
    private readonly actions: PanelActions,
  ) {
    this.gui = new GUI({ autoPlace: false, injectStyles: false, title: "Controls", width: 288 });
    this.element = this.gui.domElement;
    this.element.dataset.testid = "panel";
    this.scene = tag("scene", this.gui.add(this.world, "scene", [""]).name("Scene")) as OptionController;
    this.scene.onFinishChange((name: string) => void commands.load(name));
    this.addQuality();
    this.addWorld();
    this.addDrop();
    this.addPush();
    this.addLook();
    this.stream = new StreamFolder(this.gui.addFolder("Stream"), choices.view, (view) => actions.viewWished(view));
    this.addStatistics();
    this.access = this.gui.addFolder("Access").hide();
    tag("forget-token", this.access.add({ act: () => actions.forgetToken() }, "act").name("Forget the token")).domElement.title =
      "This tab remembers it until it is closed";
    this.restriction = new Restriction([this.scene, ...this.steering.flatMap((folder) => folder.controllers)]);
  }

  /** `why`: what changes the world is out of use; empty: it is not. */
  restrict(why: string): void {
    if (why) this.choices.push = false;
    this.restriction.set(why);
    this.dial.restrict(why);
    this.refresh();
  }

  /** Whether there is a token to be forgotten. */
  holdToken(held: boolean): void {
    this.access.show(held);
  }

  /** A recording is played, or else a scene simulated: only what works is offered. */
  setPlaying(playing: boolean): void {
    if (playing) this.choices.push = false;
    this.scene.show(!playing);
    for (const folder of this.simulated) folder.show(!playing);
    for (const controller of this.playback.controllers) controller.show(!playing || controller.property === "speed");
    this.playback.title(playing ? "Recording" : "World");
    this.refresh();
  }

  offer(welcome: Welcome): void {
    this.scene.options(welcome.scenes);
  }

  setFacts(facts: Facts): void {
    const another = facts.name !== this.facts?.name;
    this.facts = facts;
    this.world.scene = facts.name;
    if (another) {
      const [low, high] = facts.radiusRange;
      this.drop.radius = Number(((low + high) / 2 || 0.05).toPrecision(3));
      this.choices.impulse = impulseFor(this.drop.radius);
      if (!this.choices.modeChosen) this.choices.mode = modeFor(facts.groups);
    }
    this.refresh();
  }

  settle(settings: Settings): void {
    this.settled = settings;
    const [x = 0, y = 0, z = 0] = settings.gravity;
    const { restitution, friction, speed } = settings;
    const settled = { x, y, z, gravity: presetOf([x, y, z]), restitution, friction, speed, ...heldBy(settings.auto) };
    const edited = this.edited();
    if (edited) delete (settled as Partial<typeof settled>)[edited as keyof typeof settled];
    Object.assign(this.world, settled);
    this.dial.settle(settings);
    const held = goals[this.world.auto];
    this.goal.show(this.world.auto !== "off").name(held.unit);
    this.refresh();
  }

  setDial(dial: DialMessage): void {
    this.dial.offer(dial);
  }

  diagnose(diagnostics: Diagnostics): void {
    this.statistics.show(diagnostics, this.settled);
  }

  refresh(): void {
    for (const controller of this.gui.controllersRecursive()) controller.updateDisplay();
  }

  colourBy(mode: Mode): void {
    this.choices.mode = mode;
    this.choices.modeChosen = true;
    this.refresh();
  }

  /** Asks for a change; when it is refused, the control goes back to what holds. */
  private async change(what: string, wish: Parameters<Commands["set"]>[1]): Promise<void> {
    const outcome = await this.commands.set(what, wish);
    if (outcome.case !== "applied" && this.settled) this.settle(this.settled);
  }

  /** The setting that is being typed or dragged just now: what others set must not slip under the hand. */
  private edited(): string | undefined {
    const held = this.element.querySelector(".lil-slider.lil-active") ?? document.activeElement;
    const control = held?.matches("input:not([type=checkbox]), .lil-slider") && held.closest<HTMLElement>("[data-control]");
    return control ? control.dataset.control?.replace("gravity-", "") : undefined;
  }

  dropNow(): void {
    if (this.facts) void this.commands.drop(dropFor(this.facts, this.drop.count, this.drop.radius));
  }

  private simulation(name: string): GUI {
    const folder = this.gui.addFolder(name);
    this.simulated.push(folder);
    return folder;
  }

  private addWorld(): void {
    const { world } = this;
    const folder = this.gui.addFolder("World");
    this.playback = folder;
    this.steering.push(folder);
    folder.domElement.classList.add("playback");
    const setGravity = (): void => void this.change("Gravity", { gravity: [world.x, world.y, world.z] });
    tag("gravity-preset", folder.add(world, "gravity", [...Object.keys(presets), "Own"]).name("Gravity, m/s²")).onFinishChange((name: string) => {
      const preset = presets[name];
      if (!preset) return;
      [world.x, world.y, world.z] = preset;
      setGravity();
    });
    for (const axis of ["x", "y", "z"] as const) {
      tag(`gravity-${axis}`, folder.add(world, axis).step(0.01).decimals(2).name(axis)).onFinishChange(setGravity);
    }
    tag("restitution", folder.add(world, "restitution", 0, 1, 0.01).name("Restitution")).onFinishChange(
      (restitution: number) => void this.change("Restitution", { restitution }),
    );
    tag("friction", folder.add(world, "friction", 0, 1, 0.01).name("Friction")).onFinishChange(
      (friction: number) => void this.change("Friction", { friction }),
    );
    tag("speed", folder.add(world, "speed", 0.05, 4, 0.05).name("Speed, ×")).onFinishChange(
      (speed: number) => void this.change("Speed", { speed }),
    );
  }

  private addQuality(): void {
    const { world } = this;
    const folder = this.simulation("Quality");
    this.steering.push(folder);
    folder.$children.append(this.dial.element);
    const hold = (): void => void this.change("Automatic", { auto: goalFrom(world.auto, world.goal) });
    tag("auto", folder.add(world, "auto", goalNames).name("Automatic")).onFinishChange((name: GoalName) => {
      world.goal = goals[name].first;
      hold();
    }).domElement.title = "Moves the substeps of the model to hold a time per step, or a mean overlap";
    this.simulation("Now").$children.append(this.statistics.quality);
    this.goal = tag("goal", folder.add(world, "goal").min(0).decimals(3).name("")).onFinishChange(hold).hide();
  }

  private addDrop(): void {
    const folder = this.simulation("Drop spheres");
    this.steering.push(folder);
    tag("drop-count", folder.add(this.drop, "count", 1, 5000, 1).name("Count"));
    tag("drop-radius", folder.add(this.drop, "radius").min(1e-4).decimals(4).name("Radius, m"));
    tag("drop", folder.add({ act: () => this.dropNow() }, "act").name("Drop"));
  }

  private addPush(): void {
    const folder = this.simulation("Push");
    this.steering.push(folder);
    tag("push", folder.add(this.choices, "push").name("Click pushes"));
    tag("impulse", folder.add(this.choices, "impulse").min(0).name("Impulse, N s")).domElement.title = impulseNote;
  }

  private addLook(): void {
    const folder = this.gui.addFolder("Look");
    const names = Object.fromEntries(modeList.map((mode) => [modeNames[mode], mode]));
    tag("colour", folder.add(this.choices, "mode", names).name("Colour by")).onChange((mode: Mode) => this.colourBy(mode));
    tag("quality", folder.add(this.choices, "quality", { Automatic: "auto", Full: "full", Light: "light" }).name("Picture")).onChange(
      (quality: QualityChoice) => this.actions.qualityChosen(quality),
    );
    tag("theme", folder.add(this.choices, "theme", { Light: "light", Dark: "dark" }).name("Theme")).onChange((theme: ThemeName) =>
      this.actions.themed(theme),
    );
  }

  private addStatistics(): void {
    this.simulation("Statistics").$children.append(this.statistics.rest);
  }
}
