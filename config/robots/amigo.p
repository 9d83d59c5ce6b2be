;; Parameters of the AmigoBot with the H8S controller.
;;
;; Conversion factors, limits, radius and sonar places are the values of ARIA and Player for this
;; subclass. Accelerations, batteries, encoders and errors are assumed: plausible settings for such
;; a robot. Keywords: README.md.

Class     Pioneer
Subclass  amigo
Protocol  p2os

;; Values of one unit of the packets
AngleConvFactor  0.00153398 ; rad
DistConvFactor   0.5083     ; mm
VelConvFactor    0.6154     ; mm/s
RangeConvFactor  1          ; mm
DiffConvFactor   0.011      ; rad of turn per mm of half the difference of the wheel distances
Vel2Divisor      20         ; mm/s

RobotRadius      180        ; mm
RobotDiagonal    80         ; mm, half-height to the diagonal of the octagon
RobotWidth       279        ; mm
RobotLength      330        ; mm

MaxVelocity      1000       ; mm/s
MaxRVelocity     300        ; deg/s
Acceleration     300        ; mm/s2
Deceleration     300        ; mm/s2
RotAcceleration  100        ; deg/s2
RotDeceleration  100        ; deg/s2

;; Errors of the simulated dead reckoning (terms of the manual's Table 3-1)
EncodeJitter     0.01
AngleJitter      0.01
AngleDrift       0.001

;; Equipment
Battery           12.8      ; V
LowBattery        11.5      ; V
ShutdownVolts     11.0      ; V
EncoderTicksPerMM 128       ; counts

;; Sonar buffers of the LPS
FrontBuffer      30         ; readings
SideBuffer       40         ; readings on each side
FrontMaxRange    2500       ; mm

SonarNum 8
SonarArrays 1   ; arrays that fire at the same time
SonarPeriod 40  ; ms between two firings of an array
;;         #     x     y    th    mm, mm, degrees
SonarUnit  0    76   100    90
SonarUnit  1   125    75    41
SonarUnit  2   150    30    15
SonarUnit  3   150   -30   -15
SonarUnit  4   125   -75   -41
SonarUnit  5    76  -100   -90
SonarUnit  6  -140   -58  -145
SonarUnit  7  -140    58   145
