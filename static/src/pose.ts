// How a face stands at one moment.

/** One moment of the face; a decoded frame is one. */
export interface FacePose {
  vertexCount: number;
  moved: ArrayLike<number>;
  /** Three grid steps per moved point. */
  displacements: ArrayLike<number>;
  jawQuaternion: readonly [number, number, number, number];
  /** [m] from the hinge's rest place. */
  jawOffset: readonly [number, number, number];
  /** Left yaw, left pitch, right yaw, right pitch [degrees]. */
  gaze: readonly [number, number, number, number];
  /** Yaw, pitch, roll [degrees]. */
  head: readonly [number, number, number];
  /** How far the head is held forward, and the tongue put out [m]. */
  headThrust: number;
  tongueThrust: number;
}

export type Triple = [number, number, number];
