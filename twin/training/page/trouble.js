// What a crash, a break or an alarm looks and sounds like.

const LOOKED_AT = ["collision", "rapid-into-stock", "spindle-off", "gouge", "tool-broken", "spindle-stall"];
const CRASH_S = 0.4, BEEP_S = 0.16, LOUD = 0.25;

export class Trouble {
  constructor(view) {
    Object.assign(this, { view, key: "", muted: localStorage.getItem("muted") === "yes", audio: null });
    // A browser lets a page sound only behind a touch or a key.
    for (const event of ["pointerdown", "keydown"]) addEventListener(event, () => { this.audio ??= new AudioContext(); }, { once: true, capture: true });
  }

  mute(muted) {
    this.muted = muted;
    localStorage.setItem("muted", muted ? "yes" : "no");
  }

  show({ alarm, broken, tool }) {
    const told = alarm ?? broken, seen = told && LOOKED_AT.includes(told.code) ? told : null;
    const key = JSON.stringify([told?.code, told?.time_s, !!broken, tool]);
    if (key === this.key) return;
    const fresh = told && !this.key.startsWith(JSON.stringify([told.code, told.time_s]).slice(0, -1));
    this.key = key;
    this.view.say("happen", { alarm: seen, broken: !!broken, look_there: !!fresh });
    if (fresh && !this.muted) this.sound(!!seen);
  }

  /** The noise of a crash, or the two tones of a control's alarm. */
  sound(crash) {
    const { audio } = this;
    if (!audio) return;
    const loud = audio.createGain();
    loud.connect(audio.destination);
    const begin = audio.currentTime;
    if (crash) {
      const noise = audio.createBuffer(1, CRASH_S * audio.sampleRate, audio.sampleRate), samples = noise.getChannelData(0);
      for (let i = 0; i < samples.length; i++) samples[i] = (2 * Math.random() - 1) * Math.exp((-7 * i) / samples.length);
      const low = new BiquadFilterNode(audio, { type: "lowpass", frequency: 900 });
      const source = new AudioBufferSourceNode(audio, { buffer: noise });
      source.connect(low).connect(loud);
      loud.gain.value = 2 * LOUD;
      return source.start();
    }
    loud.gain.value = LOUD;
    return [880, 660].forEach((frequency, place) => {
      const tone = new OscillatorNode(audio, { type: "square", frequency });
      tone.connect(loud);
      tone.start(begin + place * BEEP_S);
      tone.stop(begin + (place + 0.8) * BEEP_S);
    });
  }
}
